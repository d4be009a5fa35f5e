#include "mapper/scan/stand_blend.h"

namespace depthgrid {
namespace {

// Unevenness of the floor: above a rug the height is 2.5 cm less, with half a degree of tilt at the
// rug's edge (living_room: 1.6 cm and 0.31 degrees rms; office_room, without rugs, 3 mm and 0.07
// degrees).
constexpr double kFloorSigmaM = 0.02;
constexpr double kFloorSigmaRad = RadFromDeg(0.35);
// SLAM is assumed correct at first: it counts as having agreed with the floor for this many frames
// (3 s) before.
constexpr int kFramesBefore = 90;

// SLAM's share of the difference between SLAM and floor: its variance is the mean square minus the
// floor's variance.
double ShareOfSlam(double square_sum, int frames, double floor_sigma) {
  const double floor_sum = (frames + kFramesBefore) * floor_sigma * floor_sigma;
  return square_sum > floor_sum ? 1.0 - floor_sum / square_sum : 0.0;
}

// The rotation, in level axes, from the pose's tilt to the tilt over the floor.
Eigen::Vector3d TiltBetween(const Pose3& pose, const CameraStand& over_floor) {
  return LogRotation(over_floor.level_from_camera * LevelFromCamera(pose).conjugate());
}

}  // namespace

void StandBlend::Add(const Pose3& slam_from_camera, const CameraStand& over_floor) {
  const double higher_m = floor_z_m_ + over_floor.height_m - slam_from_camera.translation.z();
  ++frames_;
  height_square_m2_ += higher_m * higher_m;
  tilt_square_rad2_ += TiltBetween(slam_from_camera, over_floor).squaredNorm();
}

Pose3 StandBlend::Placed(const Pose3& map_from_camera, const CameraStand& over_floor) const {
  const double height_share = ShareOfSlam(height_square_m2_, frames_, kFloorSigmaM);
  const double tilt_share = ShareOfSlam(tilt_square_rad2_, frames_, kFloorSigmaRad);
  Pose3 placed = map_from_camera;
  double& z_m = placed.translation.z();
  z_m += height_share * (floor_z_m_ + over_floor.height_m - z_m);
  if (tilt_share == 0.0) return placed;
  const Eigen::Quaterniond turned =
      ExpRotation(tilt_share * TiltBetween(map_from_camera, over_floor)) *
      LevelFromCamera(map_from_camera);
  // Rotating between two tilts may change the heading slightly, so it is restored.
  const Eigen::Quaterniond level_from_camera = LevelFromCamera({turned, {}});
  placed.rotation = (Lift(BaseOf(map_from_camera)).rotation * level_from_camera).normalized();
  return placed;
}

}  // namespace depthgrid
