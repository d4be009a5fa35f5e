#include "mapper/io/world_up.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr WorldUp kAxes[] = {WorldUp::kX,      WorldUp::kMinusX, WorldUp::kY,
                             WorldUp::kMinusY, WorldUp::kZ,      WorldUp::kMinusZ};
constexpr double kSnapRad = RadFromDeg(1.0);

}  // namespace

Eigen::Vector3d AxisOf(WorldUp up) {
  switch (up) {
    case WorldUp::kX:
      return Eigen::Vector3d::UnitX();
    case WorldUp::kMinusX:
      return -Eigen::Vector3d::UnitX();
    case WorldUp::kY:
      return Eigen::Vector3d::UnitY();
    case WorldUp::kMinusY:
      return -Eigen::Vector3d::UnitY();
    case WorldUp::kZ:
      return Eigen::Vector3d::UnitZ();
    case WorldUp::kMinusZ:
      return -Eigen::Vector3d::UnitZ();
    case WorldUp::kAuto:
      break;
  }
  Broken("an axis that is to be found has no direction yet");
}

std::string NameOf(WorldUp up) {
  constexpr const char* kNames[] = {"auto", "x", "-x", "y", "-y", "z", "-z"};
  return kNames[static_cast<int>(up)];
}

WorldUp NearestAxis(const Eigen::Vector3d& up, double within_rad) {
  const double enough = std::cos(std::max(within_rad, kSnapRad));
  for (const WorldUp axis : kAxes) {
    if (up.dot(AxisOf(axis)) > enough) return axis;
  }
  return WorldUp::kAuto;
}

Eigen::Quaterniond LevelFromWorld(const Eigen::Vector3d& up) {
  if (up == Eigen::Vector3d::UnitZ()) return Eigen::Quaterniond::Identity();
  // Half a turn has no single smallest axis.
  if (up == Eigen::Vector3d(-Eigen::Vector3d::UnitZ())) return {0.0, 1.0, 0.0, 0.0};
  return RotationBetween(up, Eigen::Vector3d::UnitZ()).normalized();
}

SlamOutput Rotated(SlamOutput slam, const Eigen::Quaterniond& level_from_world) {
  if (level_from_world.coeffs() == Eigen::Quaterniond::Identity().coeffs()) return slam;
  const Pose3 level{level_from_world, Eigen::Vector3d::Zero()};
  for (SlamPose& pose : slam.live) {
    if (pose.slam_from_camera) pose.slam_from_camera = level * *pose.slam_from_camera;
  }
  for (StampedPose& pose : slam.final) pose.world_from_camera = level * pose.world_from_camera;
  return slam;
}

}  // namespace depthgrid
