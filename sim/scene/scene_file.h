// Scene files: YAML that lists materials, groups of shapes, shapes, lights and trajectories.
#pragma once

#include <string>

#include "sim/scene/scene.h"

namespace depthgrid {

// Everything the file says, unchecked as a whole: floor and ceiling are not looked for yet.
struct SceneFile {
  Scene scene;
  std::optional<double> floor_z_m;  // as stated
};
SceneFile ReadSceneFile(const std::string& path);

}  // namespace depthgrid
