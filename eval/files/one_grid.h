// A common grid for two maps that are scored or shown together.
#pragma once

#include <string>

#include "mapper/core/grid_geometry.h"

namespace depthgrid {

// The rectangle around two maps of the same resolution. Throws InputError for maps so far apart
// that most of it belongs to neither, because it would take minutes and all memory.
GridGeometry OneGridAround(const GridGeometry& known, const std::string& known_path,
                           const GridGeometry& other, const std::string& other_path);

}  // namespace depthgrid
