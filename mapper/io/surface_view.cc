#include "mapper/io/surface_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace depthgrid::internal {
namespace {

constexpr int kPatchesAcross = 80;  // per image width, whatever its size
// Half the baseline of a normal as a share of the width: wide enough to average noise, narrow
// enough for furniture (6 of 640 pixels).
constexpr double kBaselineShare = 0.0094;
constexpr double kMaxDepthM = 5.0;    // farther, normals are too noisy on real sensors
constexpr double kSmoothShare = 0.1;  // largest relative depth change over the baseline

}  // namespace

SurfaceView ViewOf(const DepthImage& image, const PinholeCamera& camera,
                   const Pose3& world_from_camera) {
  SurfaceView view;
  view.camera = world_from_camera.translation;
  const int step_px = std::max(1, image.width_px / kPatchesAcross);
  const int base_px = std::max(2, static_cast<int>(kBaselineShare * image.width_px));
  const auto point_at = [&](int u, int v) { return Unproject(camera, u, v, image.At(u, v)); };
  for (int v = base_px; v + base_px < image.height_px; v += step_px) {
    for (int u = base_px; u + base_px < image.width_px; u += step_px) {
      const float z = image.At(u, v);
      if (!(z > 0.0F) || z > kMaxDepthM) continue;
      const float around[] = {image.At(u - base_px, v), image.At(u + base_px, v),
                              image.At(u, v - base_px), image.At(u, v + base_px)};
      const auto apart = [&](float other) {
        return !(other > 0.0F) || std::abs(other - z) > kSmoothShare * z;
      };
      if (std::any_of(std::begin(around), std::end(around), apart)) continue;
      const Eigen::Vector3d along_u = point_at(u + base_px, v) - point_at(u - base_px, v);
      const Eigen::Vector3d along_v = point_at(u, v + base_px) - point_at(u, v - base_px);
      // x right times y down points away from the camera.
      const Eigen::Vector3d normal = along_v.cross(along_u).normalized();
      view.patches.push_back(
          {world_from_camera * point_at(u, v), world_from_camera.rotation * normal});
    }
  }
  return view;
}

double ShareBelow(const std::vector<SurfaceView>& views, const Eigen::Vector3d& up,
                  double height_m) {
  std::size_t below = 0;
  std::size_t all = 0;
  for (const SurfaceView& view : views) {
    all += view.patches.size();
    for (const SurfacePatch& patch : view.patches) below += up.dot(patch.point) < height_m ? 1 : 0;
  }
  return all == 0 ? 0.0 : static_cast<double>(below) / static_cast<double>(all);
}

}  // namespace depthgrid::internal
