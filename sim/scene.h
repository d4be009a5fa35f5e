// A furnished world: geometry, materials and the camera paths its file names.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mapper/io/config.h"
#include "sim/triangle_mesh.h"

namespace depthgrid {

struct Material {
  std::string name;
  Eigen::Vector3f colour = {0.7F, 0.7F, 0.7F};  // linear RGB, 0..1
};

struct Scene {
  std::string name;
  TriangleMesh mesh;
  std::vector<Material> materials;
  double floor_z_m = 0.0;
  std::map<std::string, Config> trajectories;  // read by sim/trajectory.h
};

}  // namespace depthgrid
