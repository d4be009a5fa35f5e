#include "mapper/core/slam_epochs.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// With fewer steps the usual motion is unknown.
constexpr std::size_t kFewMotions = 6;
// After a gap this long the motion may have changed.
constexpr double kForgottenS = 1.0;
// Factor of the limit while the usual motion is not yet known. Chosen, not measured: it makes 0.33
// m at 30 Hz, and ORB-SLAM2's first pose after a loss was off by 0.6 m.
constexpr double kSurelyOff = 3.0;
// A pose this near to the origin is at it (kThere), one this far is away from it (kAway). Chosen,
// not measured.
constexpr double kThereM = 0.05;
constexpr double kThereRad = 0.05;
constexpr double kAwayM = 0.5;
constexpr double kAwayRad = 0.5;

bool IsWithin(const Pose3& a, const Pose3& b, double most_m, double most_rad) {
  return (a.translation - b.translation).norm() <= most_m &&
         a.rotation.angularDistance(b.rotation) <= most_rad;
}

bool IsAtZero(const Pose3& world_from_camera) {
  const Pose2 base = BaseOf(world_from_camera);
  return base.translation().norm() <= kThereM && std::abs(base.yaw_rad) <= kThereRad;
}

}  // namespace

bool SlamEpochs::Motions::AreFew() const { return count < kFewMotions; }

SlamStep SlamEpochs::Motions::Usual() const {
  auto reordered = steps;
  return UsualOf(std::span(reordered).first(std::min(count, steps.size())));
}

int SlamEpochs::Of(const Frame& frame) {
  if (!frame.slam_from_camera) return epoch_;
  const Posed next{frame.stamp_s, *frame.slam_from_camera, frame.slam_epoch};
  if (!first_) first_ = next.slam_from_camera;
  if (last_ && Breaks(*last_, next)) ++epoch_;
  last_ = next;
  return epoch_;
}

// A step that breaks the motion is the first of the new motion: if it was real, the usual motion
// has changed.
bool SlamEpochs::Breaks(const Posed& last, const Posed& next) {
  const double duration_s = next.stamp_s - last.stamp_s;
  const bool gap = !(duration_s < kForgottenS);
  if (gap) {
    if (!since_.AreFew()) before_ = since_;
    since_ = Motions();
    gap_ = true;
  }
  if (next.slam_epoch != last.slam_epoch) return true;
  const double step_m =
      (next.slam_from_camera.translation - last.slam_from_camera.translation).norm();
  if (IsTooFar(step_m, duration_s)) return true;
  if (gap && duration_s > 0.0) return BeginsAnew(last, next);
  if (!(duration_s > 0.0)) return false;  // stamps may repeat or go back
  const SlamStep step = StepOf(last.slam_from_camera, next.slam_from_camera, duration_s);
  const bool breaks = BreaksMotions(step);
  if (breaks) {
    if (!since_.AreFew()) {
      before_ = since_;
      gap_ = false;
    }
    since_ = Motions();
  }
  since_.Add(step);
  return breaks;
}

// During a pause a camera may move anywhere, but a restarted driver or SLAM begins at its origin.
// If instead the camera was carried back there, the map explains what it sees.
bool SlamEpochs::BeginsAnew(const Posed& last, const Posed& next) const {
  return !IsWithin(last.slam_from_camera, next.slam_from_camera, kAwayM, kAwayRad) &&
         (IsWithin(next.slam_from_camera, *first_, kThereM, kThereRad) ||
          IsAtZero(next.slam_from_camera));
}

// A SLAM that errs in one frame returns in the next, and one that was lost corrects itself
// repeatedly. So while few steps are known since the break, a step is accepted if it continues the
// motion before it, the motion since or, after a gap, starts from standing.
bool SlamEpochs::BreaksMotions(const SlamStep& step) const {
  if (!since_.AreFew()) return BreaksMotion(step, since_.Usual());
  const double times = gap_ ? kSurelyOff : 1.0;
  return BreaksMotion(step, before_.Usual(), times) &&
         (since_.count == 0 || BreaksMotion(step, since_.Usual(), times)) &&
         (!gap_ || BreaksMotion(step, SlamStep(), times));
}

}  // namespace depthgrid
