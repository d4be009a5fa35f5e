// Scene files: YAML that lists materials, groups of shapes, shapes, lights and trajectories.
#pragma once

#include <string>

#include "sim/scene/scene.h"

namespace depthgrid {

// The contents of the file, before checks of the whole scene and the search for floor and ceiling.
struct SceneFile {
  Scene scene;
  std::optional<double> floor_z_m;  // as stated
};
SceneFile ReadSceneFile(const std::string& path);

}  // namespace depthgrid
