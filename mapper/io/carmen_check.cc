#include "mapper/io/carmen_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/counted.h"
#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// Readings this near to each other are the same: logs are written in centimetres or millimetres.
constexpr double kSameRangeM = 1e-3;
// Hardly any two hits have the largest range, but all no-returns do.
constexpr double kSuspiciousShare = 0.01;
constexpr std::int64_t kFewestSuspicious = 20;

// A laser writes about the same number for all no-returns; measurements differ by more.
constexpr double kAlikeRatio = 1.05;
// This many distinct values, each with this share of the readings, are hits mistaken for
// no-returns: a laser has two or three codes for no-returns.
constexpr int kFewestKinds = 5;
constexpr double kShareOfHits = 0.005;

// No robot turns by half a turn between two scans or by one turn per second, but headings in
// degrees taken for radians do. Small steps are ignored, as stamps may be nearly equal.
constexpr double kFastestTurnRadPerS = 2.0 * kPi;
constexpr double kSmallestStepRad = 0.2;
// A step this near to a whole turn is a wrapped heading, unless the heading exceeds
// kMostWrappedRad.
constexpr double kWrapToleranceRad = 0.5;
constexpr double kMostWrappedRad = 2.0 * kPi + 1.0;
// A reset of odometry gives one such step, degrees one at most turns.
constexpr int kFewestImpossibleSteps = 3;
constexpr double kImpossibleShare = 0.01;

bool IsImpossible(double first_rad, double second_rad, double time_s) {
  const double step_rad = second_rad - first_rad;
  const double wrapped_rad = std::abs(WrapAngle(step_rad));
  const bool is_wrap = std::abs(std::abs(step_rad) - 2.0 * kPi) < kWrapToleranceRad &&
                       std::max(std::abs(first_rad), std::abs(second_rad)) < kMostWrappedRad;
  if (std::abs(step_rad) > kPi && !is_wrap) return true;
  return wrapped_rad > kSmallestStepRad && wrapped_rad > kFastestTurnRadPerS * time_s;
}

// No robot has so few scans per second; stamps in milliseconds look like that.
constexpr double kLongStepS = 5.0;
constexpr std::size_t kFewestSteps = 10;

// Logs state as field of view the angle between the first and the last reading, or a step more.
// Angles have three decimals or more; 0.009 for half a degree is 3 % off.
constexpr double kFovToleranceSteps = 1.5;
constexpr double kFovToleranceShare = 0.035;

// Poses are written with two decimals or more.
constexpr double kSamePoseM = 0.01;
constexpr double kSamePoseRad = 0.01;

bool IsHalfCircle(std::size_t readings) {
  return readings == 180 || readings == 181 || readings == 360 || readings == 361;
}

}  // namespace

void CarmenCheck::Add(const CarmenScan& scan, double no_return_m, int line_number) {
  AddReadings(scan, no_return_m, line_number);
  if (knows_mount_) AddPoses(scan, line_number);
  AddHeading(scan, line_number);
  (scan.states_angles ? any_states_angles_ : any_takes_fov_) = true;
  if (scan.states_angles) AddAngles(scan, line_number);
  if (!scan.states_angles && !knows_fov_) AddCount(scan, line_number);
}

void CarmenCheck::AddReadings(const CarmenScan& scan, double no_return_m, int line_number) {
  no_return_m_ = std::max(no_return_m_, no_return_m);
  crowd_.Add(scan.odom_from_laser, scan.range_m, min_range_m_, no_return_m);
  readings_ += static_cast<std::int64_t>(scan.range_m.size());
  for (const double range_m : scan.range_m) {
    if (range_m > 0.0 && range_m < shortest_m_) {
      shortest_m_ = range_m;
      shortest_line_ = line_number;
    }
    if (range_m > longest_m_) longest_m_ = range_m;
    if (range_m >= no_return_m && std::isfinite(range_m) && range_m > 0.0) {
      if (beyond_.empty()) {
        beyond_line_ = line_number;
        beyond_m_ = no_return_m;
      }
      ++beyond_[static_cast<int>(std::floor(std::log(range_m) / std::log(kAlikeRatio)))];
    }
    if (range_m >= min_range_m_ && range_m < no_return_m) AddHit(range_m, line_number);
  }
}

void CarmenCheck::AddHit(double range_m, int line_number) {
  if (!largest_.empty() && range_m <= largest_.rbegin()->first - kSameRangeM) return;
  Repeated& same = largest_.try_emplace(range_m, Repeated{0, line_number}).first->second;
  ++same.count;
  // As the largest grows, those left behind are no longer near it.
  largest_.erase(largest_.begin(), largest_.upper_bound(largest_.rbegin()->first - kSameRangeM));
}

// Codes for no-returns are few distinct values.
bool CarmenCheck::DifferAsHitsDo() const {
  const auto common = std::count_if(beyond_.begin(), beyond_.end(), [this](const auto& alike) {
    return static_cast<double>(alike.second) >= kShareOfHits * static_cast<double>(readings_);
  });
  return common >= kFewestKinds;
}

void CarmenCheck::AddPoses(const CarmenScan& scan, int line_number) {
  const Pose2 robot_from_laser = Between(scan.odom_from_robot, scan.odom_from_laser);
  if (!AreApart({}, robot_from_laser, kSamePoseM, kSamePoseRad)) return;
  if (stated_mounts_++ > 0) return;
  stated_mount_ = robot_from_laser;
  stated_mount_line_ = line_number;
}

void CarmenCheck::AddHeading(const CarmenScan& scan, int line_number) {
  const Heading heading = {scan.stated_yaw_rad, scan.stamp_s, line_number};
  if (!beyond_a_turn_ && std::abs(heading.yaw_rad) > 2.0 * kPi) beyond_a_turn_ = heading;
  if (last_heading_) {
    ++steps_;
    if (second_line_ == 0) second_line_ = line_number;
    steps_s_.push_back(heading.stamp_s - last_heading_->stamp_s);
    const bool impossible = IsImpossible(last_heading_->yaw_rad, heading.yaw_rad,
                                         heading.stamp_s - last_heading_->stamp_s);
    impossible_steps_ += impossible ? 1 : 0;
  }
  last_heading_ = heading;
}

void CarmenCheck::AddCount(const CarmenScan& scan, int line_number) {
  if (IsHalfCircle(scan.range_m.size())) return;
  if (uncommon_counts_++ > 0) return;
  first_count_ = scan.range_m.size();
  first_count_line_ = line_number;
}

void CarmenCheck::AddAngles(const CarmenScan& scan, int line_number) {
  const double step_rad = scan.bearing_step_rad;
  const double fov_rad = step_rad * static_cast<double>(scan.range_m.size() - 1);
  const double tolerance_rad = kFovToleranceSteps * step_rad + kFovToleranceShare * fov_rad;
  if (std::abs(scan.stated_fov_rad - fov_rad) <= tolerance_rad) return;
  if (contradictions_++ > 0) return;
  contradiction_line_ = line_number;
  contradiction_fov_rad_ = scan.stated_fov_rad;
  contradiction_step_rad_ = step_rad;
  contradiction_count_ = scan.range_m.size();
}

std::optional<std::string> CarmenCheck::DoubtOfUnits(const std::string& path) const {
  if (shortest_m_ >= no_return_m_ && longest_m_ > kAlikeRatio * shortest_m_) {
    return fmt::format(
        "{}:{}: the shortest of {} readings is {:g}, and from {:g} m on a reading is no return "
        "(sequence.laser.max_range_m): are they in metres?",
        path, shortest_line_, readings_, shortest_m_, no_return_m_);
  }
  if (!DifferAsHitsDo()) return {};
  std::int64_t count = 0;
  for (const auto& [power, readings] : beyond_) count += readings;
  return fmt::format(
      "{}:{}: {} of {} readings are {:g} m or more, which is taken for no return "
      "(sequence.laser.max_range_m, the line's own maximum or 80 m), and differ as hits do: are "
      "they in metres, and is that as far as the laser reaches?",
      path, beyond_line_, count, readings_, beyond_m_);
}

std::optional<std::string> CarmenCheck::DoubtOfLargest(const std::string& path) const {
  if (largest_.empty()) return {};
  const double largest_m = largest_.rbegin()->first;
  Repeated all = largest_.rbegin()->second;
  all.count = 0;
  for (const auto& [range_m, repeated] : largest_) {
    all.count += repeated.count;
    all.first_line = std::min(all.first_line, repeated.first_line);
  }
  // Rounded down, so that the setting covers all of them.
  const double setting_m = std::floor((largest_m - kSameRangeM) * 1e3) * 1e-3;
  if (setting_m > min_range_m_ && all.count >= kFewestSuspicious &&
      static_cast<double>(all.count) >= kSuspiciousShare * static_cast<double>(readings_)) {
    return fmt::format(
        "{}:{}: {} of {} readings are {:g} m, the largest: if that is how the laser writes \"no "
        "return\", they are drawn as walls; --set sequence.laser.max_range_m={:.3f} takes them for "
        "none",
        path, all.first_line, all.count, readings_, largest_m, setting_m);
  }
  return {};
}

std::optional<std::string> CarmenCheck::DoubtOfLongest(const std::string& path) const {
  const auto crowd = crowd_.Found();
  if (!crowd) return {};
  constexpr double kPercent = 100.0;
  return fmt::format(
      "{}: {:.1f} % of the readings are from {:.2f} to {:.2f} m, the log's longest, {:.0f} times "
      "as many as in as wide a band below, wherever the laser is: if that is how it writes \"no "
      "return\", they are drawn as walls; --set sequence.laser.max_range_m={:.2f} takes them for "
      "none",
      path, kPercent * static_cast<double>(crowd->count) / static_cast<double>(crowd->readings),
      crowd->shortest_m, crowd->longest_m, crowd->times_as_many,
      std::floor(kPercent * crowd->shortest_m) / kPercent);
}

std::optional<std::string> CarmenCheck::DoubtOfHeadings(const std::string& path) const {
  if (!beyond_a_turn_ || impossible_steps_ < kFewestImpossibleSteps ||
      impossible_steps_ < kImpossibleShare * steps_) {
    return {};
  }
  return fmt::format(
      "{}:{}: the heading is {:g}, and {} of {} headings turn faster than a robot does: they must "
      "be in radians, are they in degrees?",
      path, beyond_a_turn_->line_number, beyond_a_turn_->yaw_rad, impossible_steps_, steps_);
}

std::optional<std::string> CarmenCheck::DoubtOfStamps(const std::string& path) const {
  const double step_s = steps_s_.size() >= kFewestSteps ? UpperMedian(steps_s_) : 0.0;
  if (step_s < kLongStepS) return {};
  return fmt::format("{}:{}: scans come {:g} s after each other: are the stamps in seconds?", path,
                     second_line_, step_s);
}

std::optional<std::string> CarmenCheck::DoubtOfStatedMount(const std::string& path) const {
  if (stated_mounts_ == 0) return {};
  return fmt::format(
      "{}:{}: the line states two poses, the laser's and the robot's, {:.2f} m and {:.0f} degrees "
      "apart ({}): sequence.laser.mount is where the laser is from the first of them, and a log "
      "that states the laser's poses needs none",
      path, stated_mount_line_, stated_mount_.translation().norm(),
      std::abs(DegFromRad(stated_mount_.yaw_rad)), Counted(stated_mounts_, "such line"));
}

std::optional<std::string> CarmenCheck::DoubtOfCount(const std::string& path) const {
  if (uncommon_counts_ == 0) return {};
  return fmt::format(
      "{}:{}: FLASER with {} readings states no angles and is taken as 180 degrees wide ({}): "
      "--set sequence.laser.fov_deg=DEGREES says another width",
      path, first_count_line_, first_count_, Counted(uncommon_counts_, "such line"));
}

std::optional<std::string> CarmenCheck::DoubtOfAngles(const std::string& path) const {
  if (contradictions_ == 0) return {};
  return fmt::format(
      "{}:{}: ROBOTLASER1 states a field of view of {:.4g} rad and {} readings {:.4g} rad apart, "
      "which span {:.4g} rad; the resolution is taken ({}): one of the two is wrong",
      path, contradiction_line_, contradiction_fov_rad_, contradiction_count_,
      contradiction_step_rad_,
      contradiction_step_rad_ * static_cast<double>(contradiction_count_ - 1),
      Counted(contradictions_, "such line"));
}

std::optional<std::string> CarmenCheck::DoubtOfFov() const {
  if (!knows_fov_ || !any_states_angles_ || any_takes_fov_) return {};
  return "sequence.laser.fov_deg: has no effect because all lines of the log state their angles";
}

std::vector<std::string> CarmenCheck::Warnings(const std::string& path) const {
  const auto largest = DoubtOfLargest(path);
  const auto units = DoubtOfUnits(path);
  const auto longest = largest || units ? std::nullopt : DoubtOfLongest(path);
  std::vector<std::string> warnings;
  for (const auto& doubt :
       {largest, units, longest, DoubtOfHeadings(path), DoubtOfStamps(path), DoubtOfFov(),
        DoubtOfStatedMount(path), DoubtOfCount(path), DoubtOfAngles(path)}) {
    if (doubt) warnings.push_back(*doubt);
  }
  return warnings;
}

}  // namespace depthgrid
