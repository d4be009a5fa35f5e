// A scene: geometry, materials, lights, movers and the camera paths of its file.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/mesh/material.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/path/trajectory.h"
#include "sim/scene/mover.h"

namespace depthgrid {

// A lamp that shines the same in all directions, falling off with the square of the distance.
struct PointLight {
  Eigen::Vector3f at = {0, 0, 0};         // world, metres
  Eigen::Vector3f intensity = {1, 1, 1};  // linear RGB of a white matt surface 1 m away, facing it
};

struct Lighting {
  Eigen::Vector3f ambient = {0.45F, 0.45F, 0.45F};  // linear RGB of a white surface facing up
  Eigen::Vector3f sky = {0.6F, 0.75F, 0.95F};       // linear RGB where there is no surface
  std::vector<PointLight> lights;                   // at most kMaxLights
};
constexpr int kMaxLights = 32;

struct Scene {
  std::string name;
  TriangleMesh mesh;  // of everything static
  std::vector<Material> materials;
  double floor_z_m = 0.0;
  std::optional<double> ceiling_z_m;  // empty when there is none
  Lighting lighting;
  std::map<std::string, TrajectoryOptions> trajectories;
  std::vector<Mover> movers;  // in the order of the file
};

// Reads a scene file (.yaml, docs/scenes.md) or a mesh file (.obj .ply .stl .gltf .glb .dae).
// Throws InputError for bad input; the result has triangles, finite vertices and a floor.
// Files that it includes and that are not beside it may lie in `parts_folder`; "": none do.
Scene LoadScene(const std::string& path, const std::string& parts_folder = "");

}  // namespace depthgrid
