#include "sim/path/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

constexpr double kTableStepS = 0.02;     // step of the timing table in u (nominal seconds)
constexpr int kSmoothingSteps = 20;      // half-width of the smoothing window: 0.4 s
constexpr double kTableMargin = 1.01;    // safety factor for peaks between the table's samples
constexpr double kFastestTiming = 0.25;  // least seconds per nominal second
constexpr double kSteepestPitchRad = RadFromDeg(80.0);  // beyond, yaw is ill-defined
constexpr double kLongestS = 1e6 / kFrameRateHz;        // the most frames of an experiment
constexpr double kTurnOnTheSpotRad = RadFromDeg(30.0);  // of a planar path within one table step
// The influence of a natural spline's ends falls by a factor of 2 + sqrt(3) per knot: below 1e-3
// after 6 knots.
constexpr int kClosedPadding = 6;

std::string Shown(const Eigen::Vector3d& p) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x(), p.y(), p.z());
}

PathPose PoseOf(const Waypoint& waypoint, const TrajectoryOptions& options) {
  PathPose pose;
  if (options.kind == TrajectoryKind::kPlanar) {
    pose.position_m = {waypoint.at[0], waypoint.at[1], options.height_m};
    return pose;
  }
  pose.position_m = {waypoint.at[0], waypoint.at[1], waypoint.at[2]};
  const Eigen::Vector3d axis =
      Eigen::Vector3d(waypoint.look_at[0], waypoint.look_at[1], waypoint.look_at[2]) -
      pose.position_m;
  const double level_m = std::hypot(axis.x(), axis.y());
  pose.yaw_rad = std::atan2(axis.y(), axis.x());
  pose.pitch_rad = std::atan2(axis.z(), level_m);
  if (axis.norm() == 0.0 || std::abs(pose.pitch_rad) > kSteepestPitchRad) {
    throw InputError(options.place, "the waypoint at " + Shown(pose.position_m) +
                                        " must look less than 80 degrees up or down");
  }
  return pose;
}

// Time from one station to the next on a straight line at the bounds of speed and turn rate.
double NominalTimeS(const PathPose& a, const PathPose& b, const TrajectoryOptions& options) {
  const double turn_rad = std::hypot(b.yaw_rad - a.yaw_rad, b.pitch_rad - a.pitch_rad);
  return std::max((b.position_m - a.position_m).norm() / options.speed_mps,
                  DegFromRad(turn_rad) / options.turn_rate_dps);
}

// The waypoints in order of passing with their nominal times; yaw turns the short way between them.
class Stations {
 public:
  explicit Stations(const TrajectoryOptions& options) : options_(options) {}

  // On a closed path `waypoint` may be any integer; it is wrapped.
  void Append(int waypoint) {
    const int count = static_cast<int>(options_.waypoints.size());
    const int wrapped = ((waypoint % count) + count) % count;
    PathPose pose = PoseOf(options_.waypoints[static_cast<std::size_t>(wrapped)], options_);
    if (poses_.empty()) {
      u_.push_back(0.0);
    } else {
      const double before_rad = poses_.back().yaw_rad;
      pose.yaw_rad = before_rad + WrapAngle(pose.yaw_rad - before_rad);
      const double time_s = NominalTimeS(poses_.back(), pose, options_);
      if (time_s < 1e-6) {
        throw InputError(options_.place,
                         "two waypoints in a row are the same, at " + Shown(pose.position_m));
      }
      if (u_.back() + time_s > kLongestS) {
        throw InputError(options_.place,
                         fmt::format("the path takes more than {:.0f} s to the waypoint at {}: it "
                                     "is too far off, or the bounds are too low",
                                     kLongestS, Shown(pose.position_m)));
      }
      u_.push_back(u_.back() + time_s);
    }
    poses_.push_back(pose);
  }
  double u() const { return u_.back(); }
  const std::vector<double>& knots() const { return u_; }
  // One column per station: x y z, and for a hand-held path yaw and pitch.
  Eigen::MatrixXd Values() const {
    const bool planar = options_.kind == TrajectoryKind::kPlanar;
    Eigen::MatrixXd values(planar ? 3 : 5, static_cast<Eigen::Index>(poses_.size()));
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      values.col(column).head<3>() = poses_[k].position_m;
      if (!planar) values.col(column).tail<2>() << poses_[k].yaw_rad, poses_[k].pitch_rad;
    }
    return values;
  }

 private:
  const TrajectoryOptions& options_;
  std::vector<PathPose> poses_;
  std::vector<double> u_;
};

// A smooth upper bound of the table: the maximum over a window, then a Hann-weighted mean of the
// same width. The mean is never below the table, as the window of each maximum in it includes the
// centre.
std::vector<double> SmoothUpperBound(const std::vector<double>& table) {
  const int count = static_cast<int>(table.size());
  const auto clamped = [&](int i) { return static_cast<std::size_t>(std::clamp(i, 0, count - 1)); };
  std::vector<double> highest(table.size());
  std::vector<double> smooth(table.size());
  for (int i = 0; i < count; ++i) {
    for (int k = -kSmoothingSteps; k <= kSmoothingSteps; ++k) {
      highest[clamped(i)] = std::max(highest[clamped(i)], table[clamped(i + k)]);
    }
  }
  for (int i = 0; i < count; ++i) {
    double weights = 0.0;
    for (int k = -kSmoothingSteps; k <= kSmoothingSteps; ++k) {
      const double weight = 1.0 + std::cos(kPi * k / (kSmoothingSteps + 1.0));
      smooth[clamped(i)] += weight * highest[clamped(i + k)];
      weights += weight;
    }
    smooth[clamped(i)] /= weights;
  }
  return smooth;
}

}  // namespace

CameraPath::CameraPath(const TrajectoryOptions& options)
    : planar_(options.kind == TrajectoryKind::kPlanar), pitch_rad_(RadFromDeg(options.pitch_deg)) {
  BuildCurve(options);
  BuildTiming(options);
}

void CameraPath::BuildCurve(const TrajectoryOptions& options) {
  const int count = static_cast<int>(options.waypoints.size());
  const int padding = options.closed ? kClosedPadding : 0;
  Stations stations(options);
  int next = -padding;
  while (next <= 0) stations.Append(next++);
  first_u_ = stations.u();
  while (next < count) stations.Append(next++);
  last_u_ = stations.u();
  if (options.closed) {
    stations.Append(next++);
    last_u_ = first_u_ + options.laps * (stations.u() - first_u_);
    // Waypoints are unevenly spaced, so fractional laps may need more than their share of stations.
    constexpr double kRoundingU = 1e-9;
    while (next <= std::ceil(count * options.laps) || stations.u() < last_u_ - kRoundingU) {
      stations.Append(next++);
    }
  }
  for (int i = 0; i < padding; ++i) stations.Append(next++);
  curve_.emplace(stations.knots(), stations.Values());
}

PathPose CameraPath::PoseAt(double u) const {
  const Eigen::VectorXd value = curve_->Value(u);
  if (!planar_) return {value.head<3>(), value[3], value[4]};
  const Eigen::VectorXd slope = curve_->Slope(u);
  return {value.head<3>(), std::atan2(slope.y(), slope.x()), pitch_rad_};
}

double CameraPath::SecondsPerUnit(double u, const TrajectoryOptions& options) const {
  const Eigen::VectorXd slope = curve_->Slope(u);
  double turn_rad = 0.0;  // per unit of u
  if (planar_) {
    const Eigen::VectorXd bend = curve_->Bend(u);
    const double speed_square = slope.head<2>().squaredNorm();
    turn_rad = std::abs(slope.x() * bend.y() - slope.y() * bend.x()) / speed_square;
    if (!(turn_rad * kTableStepS < kTurnOnTheSpotRad)) {
      throw InputError(options.place, "the path turns on the spot near " + Shown(curve_->Value(u)) +
                                          ": move its waypoints apart");
    }
  } else {
    turn_rad = slope.tail<2>().norm();  // the axes of yaw and pitch are perpendicular
  }
  return std::max({kTableMargin * slope.head<3>().norm() / options.speed_mps,
                   kTableMargin * DegFromRad(turn_rad) / options.turn_rate_dps, kFastestTiming});
}

void CameraPath::BuildTiming(const TrajectoryOptions& options) {
  const int steps = std::max(2, static_cast<int>(std::ceil((last_u_ - first_u_) / kTableStepS)));
  const double step_u = (last_u_ - first_u_) / steps;
  std::vector<double> seconds_per_unit;
  for (int i = 0; i <= steps; ++i) {
    seconds_per_unit.push_back(SecondsPerUnit(first_u_ + i * step_u, options));
  }
  seconds_per_unit = SmoothUpperBound(seconds_per_unit);
  std::vector<double> times_s = {0.0};
  Eigen::MatrixXd parameter(1, steps + 1);
  parameter(0, 0) = first_u_;
  for (int i = 1; i <= steps; ++i) {
    const auto k = static_cast<std::size_t>(i);
    times_s.push_back(times_s.back() +
                      0.5 * (seconds_per_unit[k - 1] + seconds_per_unit[k]) * step_u);
    parameter(0, i) = first_u_ + i * step_u;
  }
  duration_s_ = times_s.back();
  parameter_.emplace(std::move(times_s), std::move(parameter));
}

PathPose CameraPath::At(double share) const {
  return PoseAt(parameter_->Value(share * duration_s_)[0]);
}

Pose3 CameraPoseOf(const PathPose& pose) {
  const Pose3 level = CameraOf({pose.position_m.x(), pose.position_m.y(), WrapAngle(pose.yaw_rad)},
                               pose.position_m.z());
  return level * Pose3{ExpRotation({pose.pitch_rad, 0.0, 0.0}), Eigen::Vector3d::Zero()};
}

}  // namespace depthgrid
