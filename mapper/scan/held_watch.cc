#include "mapper/scan/held_watch.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace depthgrid {
namespace {

// Less than for a recording (view_change.h), as each frame that is believed wrongly is mapped: a
// third of a second at 15 Hz and 0.8 m/s is told of depth images by this, not by that
// (docs/tried.md, "Poses that stay").
constexpr double kMovesM = 0.02;
constexpr double kTimesStep = 1.5;
// Poses more than this apart are not moved on: it helps at 2 Hz, not at 1.5 (docs/tried.md,
// "Odometry slower than the scans").
constexpr double kLongestMovedOnS = 0.6;

}  // namespace

bool HeldWatch::IsHeld(const Frame& frame) {
  repeats_ = frame.slam_from_camera && pose_ == frame.slam_from_camera;
  if (!frame.slam_from_camera) return false;
  now_.Clear();
  if (frame.depth) now_.Take(*frame.depth);
  if (frame.scan) now_.Take(*frame.scan);
  now_s_ = frame.stamp_s;
  if (!repeats_) {
    Begin(frame);
    return false;
  }
  ++run_;
  if (now_.empty()) return held_;
  if (first_.empty()) first_ = now_;
  const std::vector<double> since_first = now_.DifferencesM(first_);
  const double since_first_m = MedianChangeM(since_first);
  const double since_last_m = now_.ChangeFromM(last_);
  largest_step_m_ = std::max(largest_step_m_, since_last_m);
  const double moved_m = kMovesM + kTimesStep * largest_step_m_;
  still_.Add(now_s_, since_first, since_last_m, moved_m);
  std::swap(last_, now_);
  if (since_first_m < kBegunShare * moved_m) held_ = false;
  if (moves_ && run_ > 2 * UsualRun() && since_first_m > moved_m && !still_.stands()) held_ = true;
  return held_;
}

// The first frame with another pose.
void HeldWatch::Begin(const Frame& frame) {
  moves_ = pose_.has_value();
  const double step_s = frame.stamp_s - since_s_;
  std::optional<SlamStep> step;
  if (moves_ && frame.slam_epoch == slam_epoch_ && step_s > 0.0) {
    step = StepOf(*pose_, *frame.slam_from_camera, step_s);
    if (BreaksMotion(*step, step_.value_or(SlamStep{}))) step.reset();
  }
  step_ = step;
  since_s_ = frame.stamp_s;
  slam_epoch_ = frame.slam_epoch;
  if (moves_) runs_[poses_++ % runs_.size()] = run_;
  pose_ = frame.slam_from_camera;
  first_frame_ = frame.index;
  run_ = 1;
  held_ = false;
  still_.Begin(frame.stamp_s);
  largest_step_m_ = 0.0;
  last_ = now_;
  std::swap(first_, now_);
}

std::optional<Pose3> HeldWatch::MovedOn() const {
  const std::size_t usual = UsualRunSoFar();
  if (!step_ || held_ || !repeats_ || usual < 2 || run_ > 2 * usual) return std::nullopt;
  if (step_->duration_s > kLongestMovedOnS) return std::nullopt;
  const double moved_s = std::clamp(now_s_ - since_s_, 0.0, step_->duration_s);
  return *pose_ * Pose3{ExpRotation(moved_s * step_->turn_rate), moved_s * step_->velocity};
}

// Of the runs that were counted, at least two, the lower of the two in the middle: 1 at more than
// half the frames' rate, as runs of one and two frames alternate then.
std::size_t HeldWatch::UsualRunSoFar() const {
  const std::size_t count = std::min(poses_, runs_.size());
  if (count < 2) return 1;
  auto runs = runs_;
  const auto middle = runs.begin() + (count - 1) / 2;
  std::nth_element(runs.begin(), middle, runs.begin() + count);
  return *middle;
}

std::size_t HeldWatch::UsualRun() const {
  auto runs = runs_;
  std::nth_element(runs.begin(), runs.begin() + runs.size() / 2, runs.end());
  return runs[runs.size() / 2];
}

}  // namespace depthgrid
