// The shapes of a scene file by name (docs/scenes.md).
#pragma once

#include <string>
#include <vector>

#include "sim/shapes/wall_item.h"

namespace depthgrid {

// Names for `shape:` except "use" and "mesh", which depend on the scene file.
std::vector<std::string> ShapeNames();

// Reads the item and consumes its keys. Throws InputError for anything wrong with it. `shape` is
// one of ShapeNames().
BuiltItem BuildShape(const std::string& shape, Config& config);

}  // namespace depthgrid
