#include "sim/scene/scene.h"

#include <fmt/format.h>

#include <filesystem>

#include "mapper/core/error.h"
#include "sim/mesh/floor.h"
#include "sim/mesh/mesh_file.h"
#include "sim/mesh/scene_limits.h"
#include "sim/scene/scene_file.h"

namespace depthgrid {
namespace {

// `what` for errors: "scene" or "mover".
void RequireSaneMesh(const TriangleMesh& mesh, const std::string& what, const std::string& path) {
  if (mesh.triangles.empty()) throw InputError(path, fmt::format("the {} has no triangles", what));
  for (const auto& vertex : mesh.vertices) {
    if (!vertex.allFinite()) {
      throw InputError(path, fmt::format("a vertex of the {} is not finite", what));
    }
  }
  const Eigen::AlignedBox3f bounds = BoundsOf(mesh);
  const double extent_m = bounds.sizes().maxCoeff();
  if (extent_m > kMaxSceneExtentM) {
    throw InputError(path, fmt::format("the {} is {:.6g} m across, must be at most {} m; is it in "
                                       "other units than metres? A shape's scale changes them",
                                       what, extent_m, kMaxSceneExtentM));
  }
  const double away_m =
      std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  if (away_m > kMaxSceneCoordinateM) {
    throw InputError(
        path,
        fmt::format("the {} has a coordinate of {:.0f} m, must be at most {} m: beyond, single "
                    "precision is coarser than a millimetre; move the mesh to the origin",
                    what, away_m, kMaxSceneCoordinateM));
  }
}

// The extent of the mesh, to tell the user where a floor may be.
std::string ExtentText(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f bounds = BoundsOf(mesh);
  return fmt::format("x {:.2f} to {:.2f}, y {:.2f} to {:.2f}, z {:.2f} to {:.2f} m",
                     bounds.min().x(), bounds.max().x(), bounds.min().y(), bounds.max().y(),
                     bounds.min().z(), bounds.max().z());
}

double FloorOf(const TriangleMesh& mesh, const std::optional<double>& stated_z_m,
               const std::string& path) {
  if (!stated_z_m) {
    if (const auto floor_z_m = FindFloor(mesh)) return *floor_z_m;
    throw InputError(path,
                     "the scene has no floor: no level surface facing up covers a quarter of it (" +
                         ExtentText(mesh) + "); in a scene file a box below the mesh is one");
  }
  if (HasFloorAt(mesh, *stated_z_m)) return *stated_z_m;
  throw InputError(path, fmt::format("floor_z_m is '{}', but no level surface facing up covers a "
                                     "quarter of the scene there ({})",
                                     *stated_z_m, ExtentText(mesh)));
}

// For files without lamps: a lamp high up and far to the side, which lights the whole scene evenly
// but surfaces of different orientation differently.
PointLight DefaultLight(const Scene& scene) {
  constexpr float kFarExtents = 10.0F;
  const Eigen::Vector3f direction = Eigen::Vector3f(0.45F, 0.25F, 0.86F).normalized();
  const Eigen::AlignedBox3f bounds = BoundsOf(scene.mesh);
  const float distance_m = kFarExtents * bounds.sizes().maxCoeff();
  PointLight light;
  light.at = bounds.center() + distance_m * direction;
  light.intensity = Eigen::Vector3f::Constant(0.6F * distance_m * distance_m);
  return light;
}

SceneFile ReadAsFile(const std::string& path, const std::string& parts_folder) {
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".yaml" || extension == ".yml") {
    return ReadSceneFile(path, parts_folder);
  }
  if (!IsMeshFile(path)) {
    throw InputError(
        path, fmt::format("is neither a scene (.yaml) nor a mesh file ({})", MeshExtensions()));
  }
  SceneFile file;
  MeshFile mesh = ReadMeshFile(path);
  file.scene.name = std::filesystem::path(path).stem().string();
  file.scene.mesh = std::move(mesh.mesh);
  file.scene.materials = std::move(mesh.materials);
  return file;
}

}  // namespace

Scene LoadScene(const std::string& path, const std::string& parts_folder) {
  SceneFile file = ReadAsFile(path, parts_folder);
  Scene scene = std::move(file.scene);
  RequireSaneMesh(scene.mesh, "scene", path);
  for (const Mover& mover : scene.movers) RequireSaneMesh(mover.mesh, "mover", mover.options.place);
  scene.floor_z_m = FloorOf(scene.mesh, file.floor_z_m, path);
  scene.ceiling_z_m = FindCeiling(scene.mesh, scene.floor_z_m);
  if (scene.lighting.lights.empty()) scene.lighting.lights.push_back(DefaultLight(scene));
  return scene;
}

}  // namespace depthgrid
