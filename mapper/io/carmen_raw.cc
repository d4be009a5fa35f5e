#include "mapper/io/carmen_raw.h"

#include <fmt/format.h>

#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/slam_step.h"

namespace depthgrid {
namespace {

Pose2 PoseBetween(const CarmenOdometry& before, const CarmenOdometry& after, double stamp_s) {
  const double time_s = after.stamp_s - before.stamp_s;
  const double share = time_s > 0.0 ? (stamp_s - before.stamp_s) / time_s : 0.0;
  const Pose2& a = before.odom_from_robot;
  const Pose2& b = after.odom_from_robot;
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
          WrapAngle(a.yaw_rad + share * WrapAngle(b.yaw_rad - a.yaw_rad))};
}

bool AreTooFarApart(const CarmenOdometry& before, const CarmenOdometry& after) {
  const double time_s = after.stamp_s - before.stamp_s;
  const double step_m =
      (after.odom_from_robot.translation() - before.odom_from_robot.translation()).norm();
  return time_s > kMostOdometryGapS || IsTooFar(step_m, time_s);
}

}  // namespace

void CarmenRaw::Rewind() {
  passed_ = 0;
  robot_from_laser_ = {};
  if (!is_used_) odometry_.clear();
}

bool CarmenRaw::Begin() {
  is_used_ = has_scans_;
  return is_used_;
}

CarmenLine CarmenRaw::Take(CarmenLine line) {
  if (const auto* odometry = std::get_if<CarmenOdometry>(&line)) {
    if (!is_used_) odometry_.push_back(*odometry);
    ++passed_;
    return CarmenOther{};
  }
  if (const auto* offset = std::get_if<CarmenOffset>(&line)) {
    if (takes_offsets_) TakeOffset(*offset);
    return CarmenOther{};
  }
  if (auto* raw = std::get_if<CarmenRawScan>(&line)) {
    has_scans_ = true;
    return is_used_ ? Placed(std::move(raw->scan)) : CarmenOther{};
  }
  const auto* damage = std::get_if<CarmenDamage>(&line);
  if (damage == nullptr || !damage->is_raw) return line;
  has_scans_ = has_scans_ || damage->is_scan;
  return is_used_ ? std::move(line) : CarmenOther{};
}

void CarmenRaw::TakeOffset(const CarmenOffset& offset) {
  switch (offset.of) {
    case CarmenOffset::Of::kX:
      robot_from_laser_.x_m = offset.value;
      break;
    case CarmenOffset::Of::kY:
      robot_from_laser_.y_m = offset.value;
      break;
    case CarmenOffset::Of::kYaw:
      robot_from_laser_.yaw_rad = WrapAngle(offset.value);
      break;
  }
}

// Looks from the scan's place in the log on, not from the stamps alone: a clock that was set back
// gives them twice.
CarmenLine CarmenRaw::Placed(CarmenScan scan) const {
  std::size_t after = passed_;  // the first that is later than the scan
  while (after > 0 && odometry_[after - 1].stamp_s > scan.stamp_s) --after;
  while (after < odometry_.size() && odometry_[after].stamp_s <= scan.stamp_s) ++after;
  const auto missing = [&](const std::string& fault) {
    return CarmenDamage{"RAWLASER1 without odometry at its time", true, fault, true};
  };
  if (odometry_.empty()) return missing("the log has no usable ODOM line");
  const bool is_at_last = after > 0 && odometry_[after - 1].stamp_s == scan.stamp_s;
  if (is_at_last) {
    scan.odom_from_robot = odometry_[after - 1].odom_from_robot;
  } else if (after == 0 || after == odometry_.size()) {
    return missing(fmt::format("stamp {:.6f} is {} ODOM line's", scan.stamp_s,
                               after == 0 ? "before the first" : "behind the last"));
  } else if (AreTooFarApart(odometry_[after - 1], odometry_[after])) {
    return missing(fmt::format(
        "stamp {:.6f} is between ODOM lines of {:.6f} and {:.6f}, must be at most {} s and 10 m "
        "apart",
        scan.stamp_s, odometry_[after - 1].stamp_s, odometry_[after].stamp_s, kMostOdometryGapS));
  } else {
    scan.odom_from_robot = PoseBetween(odometry_[after - 1], odometry_[after], scan.stamp_s);
  }
  scan.odom_from_laser = scan.odom_from_robot * robot_from_laser_;
  scan.stated_yaw_rad = scan.odom_from_laser.yaw_rad;
  return scan;
}

}  // namespace depthgrid
