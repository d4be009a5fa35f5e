#include "mapper/core/slam_epochs.h"

#include <algorithm>
#include <span>

namespace depthgrid {
namespace {

// Of so few steps before it none is judged by what is usual.
constexpr std::size_t kFewSteps = 6;
// After a gap as long the motion may be another.
constexpr double kForgottenS = 1.0;

}  // namespace

int SlamEpochs::Of(const Frame& frame) {
  if (!frame.slam_from_camera) return epoch_;
  const Posed next{frame.stamp_s, *frame.slam_from_camera, frame.slam_epoch};
  if (last_ && Breaks(*last_, next)) ++epoch_;
  last_ = next;
  return epoch_;
}

// A motion becomes the newest step.
bool SlamEpochs::Breaks(const Posed& last, const Posed& next) {
  const double duration_s = next.stamp_s - last.stamp_s;
  if (!(duration_s < kForgottenS)) step_count_ = 0;
  if (next.slam_epoch != last.slam_epoch) return true;
  const double step_m =
      (next.slam_from_camera.translation - last.slam_from_camera.translation).norm();
  if (IsTooFar(step_m, duration_s)) return true;
  if (!(duration_s > 0.0)) return false;  // stamps may repeat or go back
  const SlamStep step = StepOf(last.slam_from_camera, next.slam_from_camera, duration_s);
  auto recent = steps_;
  const std::span known(recent.data(), std::min(step_count_, recent.size()));
  if (known.size() >= kFewSteps && BreaksMotion(step, UsualOf(known))) {
    step_count_ = 0;  // were it a motion after all, what was usual no longer is
    return true;
  }
  steps_[step_count_++ % steps_.size()] = step;
  return false;
}

}  // namespace depthgrid
