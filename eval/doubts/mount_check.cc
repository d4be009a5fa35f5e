#include "eval/doubts/mount_check.h"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "eval/doubts/stretches.h"
#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

constexpr double kLeastMountWayM = 2.0;
constexpr double kLeastMountTurnRad = kPi;
const double kLeastMountRad = RadFromDeg(10.0);
constexpr double kLeastMountM = 0.1;
// For 16 lasers that were rotated, displaced or both, the misfit fell to 0.02 to 0.44 of its value.
// For 80 logs with other faults or none, and scans not mirrored, estimates of 10 degrees or 0.1 m
// left 0.55 or more.
constexpr double kFitsBetter = 0.5;
// Paths that differ more have different scales (ScaleDoubt).
constexpr double kMostScale = 1.3;
// If all turns are alike, position and angle cannot be separated; the position is then taken to be
// small. Prior sigma of the laser's position, and the poses' error over a stretch.
constexpr double kMountNearM = 0.5;
constexpr double kStretchErrorM = 0.02;

// The hand-eye equation, given_from_next * mount = mount * laser_from_next, of a stretch's
// positions: (R - 1) p - L (cos, sin) = -t, with R and t SLAM's rotation and translation, p and
// (cos, sin) the mount's position and heading, and L (cos, sin) the laser's translation rotated by
// that heading.
struct HandEye {
  Eigen::Matrix2d of_position;
  Eigen::Matrix2d of_heading;
  Eigen::Vector2d value;

  explicit HandEye(const Stretch& stretch) {
    const double c = std::cos(stretch.slam.yaw_rad);
    const double s = std::sin(stretch.slam.yaw_rad);
    of_position << c - 1.0, -s, s, c - 1.0;
    of_heading << -stretch.map.x_m, stretch.map.y_m, -stretch.map.y_m, -stretch.map.x_m;
    value = -stretch.slam.translation();
  }
  double SquaredMisfit(const Pose2& mount) const {
    const Eigen::Vector2d heading(std::cos(mount.yaw_rad), std::sin(mount.yaw_rad));
    return (of_position * mount.translation() + of_heading * heading - value).squaredNorm();
  }
};

double MountMisfit(const std::vector<HandEye>& equations, const Pose2& mount) {
  double sum = 0.0;
  for (const HandEye& equation : equations) sum += equation.SquaredMisfit(mount);
  return std::sqrt(sum);
}

struct MountFit {
  Pose2 mount;
  double scale = 1.0;  // SLAM's path length over the laser's
};

// Linear least squares with (cos, sin) of any norm, then again for the position, with norm 1.
MountFit SolveMount(const std::vector<HandEye>& equations, bool with_position) {
  Eigen::Matrix2d h_position = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d h_both = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d h_heading = Eigen::Matrix2d::Zero();
  Eigen::Vector2d g_position = Eigen::Vector2d::Zero();
  Eigen::Vector2d g_heading = Eigen::Vector2d::Zero();
  for (const HandEye& equation : equations) {
    h_position += equation.of_position.transpose() * equation.of_position;
    h_both += equation.of_position.transpose() * equation.of_heading;
    h_heading += equation.of_heading.transpose() * equation.of_heading;
    g_position += equation.of_position.transpose() * equation.value;
    g_heading += equation.of_heading.transpose() * equation.value;
  }
  // Zero: the position is taken to be 0.
  Eigen::Matrix2d position_covariance = Eigen::Matrix2d::Zero();
  if (with_position) {
    constexpr double kNear = kStretchErrorM * kStretchErrorM / (kMountNearM * kMountNearM);
    position_covariance = (h_position + kNear * Eigen::Matrix2d::Identity()).inverse();
  }
  const Eigen::Matrix2d h_rest = h_heading - h_both.transpose() * position_covariance * h_both;
  const Eigen::Vector2d g_rest = g_heading - h_both.transpose() * position_covariance * g_position;
  const Eigen::Vector2d solved = h_rest.inverse() * g_rest;
  const Eigen::Vector2d heading = solved.normalized();
  const Eigen::Vector2d position = position_covariance * (g_position - h_both * heading);
  return {{position.x(), position.y(), std::atan2(heading.y(), heading.x())}, solved.norm()};
}

}  // namespace

std::optional<Pose2> MountDoubt(const MappingRun& run) {
  std::vector<HandEye> equations;
  double way_m = 0.0, turn_rad = 0.0;
  for (const Stretch& stretch : WaysAndTurnsOf(run)) {
    equations.emplace_back(stretch);
    way_m += stretch.longer_m();
    turn_rad += stretch.larger_turn_rad();
  }
  if (way_m < kLeastMountWayM) return {};
  const MountFit fit = SolveMount(equations, turn_rad >= kLeastMountTurnRad);
  if (!(fit.scale > 1.0 / kMostScale && fit.scale < kMostScale)) return {};
  if (std::abs(fit.mount.yaw_rad) < kLeastMountRad &&
      fit.mount.translation().norm() < kLeastMountM) {
    return {};
  }
  if (MountMisfit(equations, fit.mount) > kFitsBetter * MountMisfit(equations, {})) return {};
  return fit.mount;
}

}  // namespace depthgrid
