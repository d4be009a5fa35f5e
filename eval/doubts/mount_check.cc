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
// Of 16 lasers that were turned, off or both the misfit became 0.02 to 0.44 of what it was. Of 80
// logs with other faults or none whose scans were not mirrored, what turned by 10 degrees or moved
// by 0.1 m left 0.55 of it or more.
constexpr double kFitsBetter = 0.5;
// Ways that differ more are of another scale (ScaleDoubt).
constexpr double kMostScale = 1.3;
// Turns that are all alike do not tell a position from an angle: it is near then. How far a laser
// may be, against how far poses err over a stretch.
constexpr double kMountNearM = 0.5;
constexpr double kStretchErrorM = 0.02;

// The hand-eye equation, given_from_next * mount = mount * laser_from_next, of a stretch's
// positions: (R - 1) p - L (cos, sin) = -t, with R and t SLAM's turn and way, p and (cos, sin) the
// mount's position and heading, and L (cos, sin) the laser's way turned by the latter.
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
  double scale = 1.0;  // SLAM's way over the laser's
};

// Linear least squares with a heading of any length, then the position again with one of length 1.
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
  Eigen::Matrix2d position_covariance = Eigen::Matrix2d::Zero();  // none: it is known to be 0
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
