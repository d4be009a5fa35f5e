#include "mapper/scan/held_watch.h"

#include <algorithm>
#include <utility>

namespace depthgrid {
namespace {

// Less than for a recording (view_change.h), as each frame that is believed wrongly is mapped: a
// third of a second at 15 Hz and 0.8 m/s is told of depth images by this, not by that
// (docs/tried.md, "Poses that stay").
constexpr double kMovesM = 0.02;
constexpr double kTimesStep = 1.5;

}  // namespace

bool HeldWatch::IsHeld(const Frame& frame) {
  if (!frame.slam_from_camera) return false;
  now_.Clear();
  if (frame.depth) now_.Take(*frame.depth);
  if (frame.scan) now_.Take(*frame.scan);
  if (pose_ != frame.slam_from_camera) {
    moves_ = pose_.has_value();
    if (moves_) runs_[poses_++ % runs_.size()] = run_;
    pose_ = frame.slam_from_camera;
    first_frame_ = frame.index;
    run_ = 1;
    held_ = false;
    largest_step_m_ = 0.0;
    last_ = now_;
    std::swap(first_, now_);
    return false;
  }
  ++run_;
  if (now_.empty()) return held_;
  if (first_.empty()) first_ = now_;
  const double since_first_m = now_.ChangeFromM(first_);
  largest_step_m_ = std::max(largest_step_m_, now_.ChangeFromM(last_));
  const double moved_m = kMovesM + kTimesStep * largest_step_m_;
  std::swap(last_, now_);
  if (since_first_m < kBegunShare * moved_m) held_ = false;
  if (moves_ && run_ > 2 * UsualRun() && since_first_m > moved_m) held_ = true;
  return held_;
}

std::size_t HeldWatch::UsualRun() const {
  auto runs = runs_;
  std::nth_element(runs.begin(), runs.begin() + runs.size() / 2, runs.end());
  return runs[runs.size() / 2];
}

}  // namespace depthgrid
