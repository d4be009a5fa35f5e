#include "mapper/core/slam_epochs.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "mapper/core/level.h"

namespace depthgrid {
namespace {

// So few do not tell what is usual.
constexpr std::size_t kFewSteps = 6;
// After a gap as long the motion may be another.
constexpr double kForgottenS = 1.0;
// A step is off so many times what is too much once the usual is known, where it is not. Chosen, of
// no measurement: 0.33 m at 30 Hz, and ORB-SLAM2's first pose after a loss was off by 0.6 m.
constexpr double kSurelyOff = 3.0;
// A pose so near to the origin is there, and one so far away from it is not. Chosen, of no
// measurement.
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

bool SlamEpochs::Motions::AreFew() const { return count < kFewSteps; }

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

// The step that breaks is the first of what comes after: were it a motion after all, what was usual
// no longer is.
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

// Over a pause a camera may go anywhere, but a driver or a SLAM that was started again counts from
// its origin. A camera that was taken back there is where the map explains what it sees.
bool SlamEpochs::BeginsAnew(const Posed& last, const Posed& next) const {
  return !IsWithin(last.slam_from_camera, next.slam_from_camera, kAwayM, kAwayRad) &&
         (IsWithin(next.slam_from_camera, *first_, kThereM, kThereRad) ||
          IsAtZero(next.slam_from_camera));
}

// SLAM that errs for a frame comes back in the next, and one that was lost corrects itself again
// and again: while little is known of the motion since, a step is one that goes on as before, as
// since or, after a gap, from standing.
bool SlamEpochs::BreaksMotions(const SlamStep& step) const {
  if (!since_.AreFew()) return BreaksMotion(step, since_.Usual());
  const double times = gap_ ? kSurelyOff : 1.0;
  return BreaksMotion(step, before_.Usual(), times) &&
         (since_.count == 0 || BreaksMotion(step, since_.Usual(), times)) &&
         (!gap_ || BreaksMotion(step, SlamStep(), times));
}

}  // namespace depthgrid
