// Maps that are laid on each other, to be scored or shown.
#pragma once

#include <string>

#include "mapper/core/grid_geometry.h"

namespace depthgrid {

// The rectangle around two maps of one resolution. Throws InputError for maps so far apart that
// most of it belongs to neither: what is done with it would take minutes, and all memory.
GridGeometry OneGridAround(const GridGeometry& known, const std::string& known_path,
                           const GridGeometry& other, const std::string& other_path);

}  // namespace depthgrid
