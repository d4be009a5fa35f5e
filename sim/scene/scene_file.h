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
// Included files may also lie in `parts_folder`; "": none do.
SceneFile ReadSceneFile(const std::string& path, const std::string& parts_folder = "");

}  // namespace depthgrid
