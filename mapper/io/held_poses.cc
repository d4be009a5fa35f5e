#include "mapper/io/held_poses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/level.h"
#include "mapper/core/median.h"
#include "mapper/io/pose_runs.h"

namespace depthgrid {
namespace {

// How much farther the readings that both have are in a than in b.
std::vector<double> DifferencesM(const std::vector<double>& a_m, const std::vector<double>& b_m) {
  std::vector<double> differences_m;
  for (std::size_t i = 0; i < std::min(a_m.size(), b_m.size()); ++i) {
    if (a_m[i] > 0.0 && b_m[i] > 0.0) differences_m.push_back(a_m[i] - b_m[i]);
  }
  return differences_m;
}

// Whether a step is too small for the readings' change, as of an encoder that was unplugged and
// then counts on from where it stopped.
bool IsTooSmall(const Pose2& step, double change_m, const std::vector<double>& range_m) {
  std::vector<double> seen_m;
  for (const double reading_m : range_m) {
    if (reading_m > 0.0) seen_m.push_back(reading_m);
  }
  if (seen_m.size() < kFewReadings) return false;
  const double turned_m = std::abs(step.yaw_rad) * UpperMedian(std::move(seen_m));
  return step.translation().norm() + turned_m < kBegunShare * change_m;
}

}  // namespace

void HeldPoses::Add(const OdometryPose& pose, std::vector<double> range_m, double min_range_m,
                    double no_return_m) {
  for (double& reading_m : range_m) {
    if (!(reading_m >= min_range_m && reading_m < no_return_m)) reading_m = 0.0;
  }
  const Pose2& odom_from_laser = pose.odom_from_laser;
  const std::size_t scan = held_.size();
  const bool is_first = scan == 0;
  held_.push_back(false);
  if (is_first || poses_.back().odom_from_laser != odom_from_laser) {
    if (!is_first && held_[scan - 1] && !TellsTheWay(pose, range_m)) {
      untold_.push_back({moved_from_, scan});
    }
    moves_ = !is_first;
    first_m_ = range_m;
    moved_from_ = scan + 1;
    still_.Begin(pose.stamp_s);
  } else {
    const std::vector<double> since_first = DifferencesM(range_m, first_m_);
    const double since_first_m = MedianChangeM(since_first);
    const double since_last_m = MedianChangeM(DifferencesM(range_m, last_m_));
    const double moved_m = kViewMovedM + kTimesNoise * since_last_m;
    still_.Add(pose.stamp_s, since_first, since_last_m, moved_m);
    if (since_first_m < kBegunShare * moved_m) moved_from_ = scan + 1;
    if (moves_ && since_first_m > moved_m && !still_.stands()) {
      for (std::size_t i = moved_from_; i <= scan; ++i) held_[i] = true;
    }
  }
  poses_.push_back(pose);
  last_m_ = std::move(range_m);
}

// Whether the way to this pose, after scans that were held, may be interpolated. Over longer holds
// it is no straight one: over 2 s an office log's errors doubled (docs/tried.md, "Odometry slower
// than the scans").
bool HeldPoses::TellsTheWay(const OdometryPose& pose, const std::vector<double>& range_m) const {
  constexpr double kMostS = 1.0;
  return pose.stamp_s - poses_[moved_from_ - 1].stamp_s <= kMostS &&
         !IsTooSmall(Between(poses_.back().odom_from_laser, pose.odom_from_laser),
                     MedianChangeM(DifferencesM(range_m, first_m_)), range_m);
}

// Poses after an untold way are of another epoch, unless all before was only read too often.
std::vector<TimedPose> HeldPoses::Frames(const std::vector<bool>& repeated) const {
  std::vector<TimedPose> frames;
  int ways = 0;
  auto untold = untold_.begin();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (untold != untold_.end() && untold->end == i) {
      ways += repeated[untold->first] ? 0 : 1;
      ++untold;
    }
    frames.push_back({poses_[i].stamp_s, Lift(poses_[i].odom_from_laser), poses_[i].epoch + ways});
  }
  return frames;
}

void HeldPoses::Mend() {
  std::vector<std::optional<Pose3>> poses;
  for (const OdometryPose& pose : poses_) poses.emplace_back(Lift(pose.odom_from_laser));
  const RepeatedPoses repeated = FindRepeated(PoseRunsOf(poses), poses);
  times_ = repeated.times;
  std::vector<bool> held = held_;
  for (std::size_t i = 0; i < held.size(); ++i) held[i] = held[i] || repeated.held[i];
  const MendedPoses mended = MendHeld(Frames(repeated.held), held);
  gaps_ = mended.gaps;
  for (std::size_t i = 0; !gaps_.empty() && i < held.size(); ++i) {
    mended_.emplace_back(poses_[i].odom_from_laser);
    if (!held[i]) continue;
    mended_[i].reset();
    if (mended.poses[i]) mended_[i] = PlanarPoseOf(*mended.poses[i]);
  }
  poses_ = {};
}

bool HeldPoses::IsLost(std::size_t scan) const { return scan < mended_.size() && !mended_[scan]; }

Pose2 HeldPoses::PoseOr(std::size_t scan, const Pose2& logged) const {
  return scan < mended_.size() && mended_[scan] ? *mended_[scan] : logged;
}

}  // namespace depthgrid
