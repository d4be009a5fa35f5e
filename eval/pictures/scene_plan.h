// A plan of a scene, for writing paths.
#pragma once

#include <vector>

#include "eval/pictures/map_picture.h"
#include "sim/scene/scene.h"

namespace depthgrid {

// The geometry in the truth map's default height band, with these paths and lines at whole metres.
// Cells have the size of a map's, or are larger if the picture would be too large.
RgbImage PlanOf(const Scene& scene, const std::vector<Path>& paths);

}  // namespace depthgrid
