#include "sim/scene/mover_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// Whether the point is inside a closed, outward-oriented surface, by the winding number: the sum of
// the solid angles of the triangles (Van Oosterom and Strackee 1983) over that of a sphere.
bool IsInside(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double half_angles_rad = 0.0;
  for (const auto& corners : mesh.triangles) {
    const auto to_corner = [&](int k) -> Eigen::Vector3d {
      return mesh.vertices[corners[static_cast<std::size_t>(k)]].cast<double>() - point;
    };
    const Eigen::Vector3d a = to_corner(0), b = to_corner(1), c = to_corner(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles_rad +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles_rad > kPi;  // a winding number of 1/2: the sum of half angles is 2 pi inside
}

void KeepNearer(const DepthFrame& of_mover, DepthFrame& frame) {
  for (std::size_t i = 0; i < frame.depth.z_m.size(); ++i) {
    const float mover_z_m = of_mover.depth.z_m[i];
    float& z_m = frame.depth.z_m[i];
    if (mover_z_m == kInvalidDepth || (z_m != kInvalidDepth && z_m <= mover_z_m)) continue;
    z_m = mover_z_m;
    if (!frame.incidence_cos.empty()) frame.incidence_cos[i] = of_mover.incidence_cos[i];
  }
}

}  // namespace

MoverScene::MoverScene(const Scene& scene, RayIsa isa) : floor_z_m_(scene.floor_z_m) {
  for (const Mover& mover : scene.movers) {
    movers_.push_back(
        {MoverPath(mover.options), mover.mesh, BoundsOf(mover.mesh), RayScene(mover.mesh, isa)});
  }
}

std::vector<MoverPlace> MoverScene::At(const Trajectory& trajectory, std::size_t frame) const {
  std::vector<MoverPlace> places;
  if (movers_.empty()) return places;
  const double time_s = trajectory[frame].stamp_s - trajectory.front().stamp_s;
  const Pose2 world_from_base = BaseOf(trajectory[frame].world_from_camera);
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const auto pose = movers_[i].path.At(time_s, world_from_base);
    if (!pose) continue;
    Pose3 world_from_mover = Lift(*pose);
    world_from_mover.translation.z() = floor_z_m_;
    places.push_back({i, world_from_mover});
  }
  return places;
}

double MoverScene::DistanceM(const MoverPlace& place, const Eigen::Vector3d& point_in_world,
                             double limit_m) const {
  const Ready& mover = movers_[place.mover];
  const Eigen::Vector3d point = Inverse(place.world_from_mover) * point_in_world;
  const Eigen::Vector3f as_float = point.cast<float>();
  if (mover.bounds.contains(as_float) && IsInside(mover.mesh, point)) return 0.0;
  return mover.rays.DistanceToSurface(as_float, static_cast<float>(limit_m));
}

bool MoverScene::Passes(const MoverPlace& before, const Eigen::Vector3d& camera_before,
                        const MoverPlace& now, const Eigen::Vector3d& camera_now) const {
  const Eigen::Vector3d from = Inverse(before.world_from_mover) * camera_before;
  const Eigen::Vector3d to = Inverse(now.world_from_mover) * camera_now;
  return movers_[now.mover].rays.Occluded(from.cast<float>(), to.cast<float>());
}

namespace {

std::optional<MoverPlace> PlaceOf(std::size_t mover, const std::vector<MoverPlace>& places) {
  for (const MoverPlace& place : places) {
    if (place.mover == mover) return place;
  }
  return {};
}

// Describes the first frame before which the mover passes through the camera, if any.
std::optional<std::string> PassingText(const Trajectory& trajectory, std::size_t mover,
                                       const MoverScene& movers, const std::string& what) {
  std::optional<MoverPlace> before;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Vector3d& at = trajectory[i].world_from_camera.translation;
    const std::optional<MoverPlace> now = PlaceOf(mover, movers.At(trajectory, i));
    if (before && now &&
        movers.Passes(*before, trajectory[i - 1].world_from_camera.translation, *now, at)) {
      return fmt::format(
          "frame {} at ({:.2f}, {:.2f}, {:.2f}): {} has gone through the camera "
          "since the frame before",
          i, at.x(), at.y(), at.z(), what);
    }
    before = now;
  }
  return {};
}

}  // namespace

std::optional<std::string> NearMoverText(const Trajectory& trajectory, const Scene& scene,
                                         const MoverScene& movers, double clearance_m) {
  // Larger than the clearance: the limit is rounded to single precision and may be returned as the
  // distance.
  const double limit_m = clearance_m + 0.1;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const auto distance_m = [&](std::size_t frame) {
      const auto place = PlaceOf(i, movers.At(trajectory, frame));
      if (!place) return limit_m;
      return movers.DistanceM(*place, trajectory[frame].world_from_camera.translation, limit_m);
    };
    const std::string what = "mover '" + scene.movers[i].name + "'";
    if (auto near = NearText(trajectory, distance_m, clearance_m, what)) return near;
    if (auto passing = PassingText(trajectory, i, movers, what)) return passing;
  }
  return {};
}

namespace {

// Visibility of a mover in one frame.
struct MoverView {
  const RayScene& room;
  const RayScene& mover;
  const PinholeCamera& camera;
  double most_m = 0.0;
  Pose3 world_from_camera;
  Pose3 world_from_mover;

  bool ShowsPoint(const Eigen::Vector3d& point_in_mover) const {
    const Eigen::Vector3d in_world = world_from_mover * point_in_mover;
    const Eigen::Vector3d in_camera = Inverse(world_from_camera) * in_world;
    if (!(in_camera.z() > 0.0 && in_camera.z() <= most_m)) return false;
    const Eigen::Array2d pixel = Project(camera, in_camera);
    const Eigen::Array2d most(camera.width_px - 1, camera.height_px - 1);
    if ((pixel < 0.0).any() || (pixel > most).any()) return false;
    return !room.Occluded(world_from_camera.translation.cast<float>(), in_world.cast<float>());
  }
  bool ShowsAt(double u_px, double v_px) const {
    const Eigen::Vector3d to = Unproject(camera, u_px, v_px, 1.0);
    const Pose3 mover_from_camera = Inverse(world_from_mover) * world_from_camera;
    // Directions have z = 1 in camera axes, so hit distances are depths.
    const auto depth_m = [&](const RayScene& rays, const Pose3& from_camera) {
      Ray ray;
      ray.origin = from_camera.translation.cast<float>();
      ray.direction = (from_camera.rotation * to).cast<float>();
      const auto hit = rays.NearestHit(ray);
      return hit ? static_cast<double>(hit->distance) : std::numeric_limits<double>::infinity();
    };
    const double mover_m = depth_m(mover, mover_from_camera);
    return std::isfinite(mover_m) && mover_m <= most_m &&
           mover_m < depth_m(room, world_from_camera);
  }
  // Whether any vertex of the mover is visible, or any pixel shows it.
  bool Shows(const TriangleMesh& mesh) const {
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      if (ShowsPoint(vertex.cast<double>())) return true;
    }
    constexpr int kRows = 12, kColumns = 16;
    for (int i = 0; i < kRows * kColumns; ++i) {
      const double u_px = (i % kColumns + 0.5) * camera.width_px / kColumns;
      const double v_px = (i / kColumns + 0.5) * camera.height_px / kRows;
      if (ShowsAt(u_px, v_px)) return true;
    }
    return false;
  }
};

}  // namespace

std::vector<std::string> UnseenMovers(const Trajectory& trajectory, const Scene& scene,
                                      const RayScene& room, const MoverScene& movers,
                                      const PinholeCamera& camera, double most_m) {
  std::vector<std::string> unseen;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    bool seen = false;
    for (std::size_t frame = 0; frame < trajectory.size() && !seen; ++frame) {
      const auto place = PlaceOf(i, movers.At(trajectory, frame));
      if (!place) continue;
      const MoverView view = {room,
                              movers.RaysOf(i),
                              camera,
                              most_m,
                              trajectory[frame].world_from_camera,
                              place->world_from_mover};
      seen = view.Shows(scene.movers[i].mesh);
    }
    if (!seen) unseen.push_back(scene.movers[i].name);
  }
  return unseen;
}

MoverCamera::MoverCamera(const MoverScene& movers, const PinholeCamera& camera) {
  for (std::size_t i = 0; i < movers.size(); ++i) cameras_.emplace_back(movers.RaysOf(i), camera);
}

void MoverCamera::DrawOver(const Pose3& world_from_camera, const std::vector<MoverPlace>& places,
                           DepthFrame& frame) const {
  for (const MoverPlace& place : places) {
    const DepthCamera& camera = cameras_[place.mover];
    const Pose3 mover_from_camera = Inverse(place.world_from_mover) * world_from_camera;
    if (frame.incidence_cos.empty()) {
      KeepNearer({camera.Render(mover_from_camera), {}}, frame);
    } else {
      KeepNearer(camera.RenderWithIncidence(mover_from_camera), frame);
    }
  }
}

}  // namespace depthgrid
