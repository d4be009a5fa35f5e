// A scene from above, for whoever writes paths through it.
#pragma once

#include <vector>

#include "eval/pictures/map_picture.h"
#include "sim/scene/scene.h"

namespace depthgrid {

// What stands in the truth map's default band, with these paths and lines at whole metres. Cells
// are those of maps, larger where the scene is so large that nobody could look at the picture.
RgbImage PlanOf(const Scene& scene, const std::vector<Path>& paths);

}  // namespace depthgrid
