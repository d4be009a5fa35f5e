#include "mapper/core/slam_step.h"

#include <algorithm>

#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// Upper bounds between poses: a car's emergency braking, and a hand whose turn rate changes by 1
// rad/s within a frame at 30 Hz.
constexpr double kAccelerationMps2 = 10.0;
constexpr double kTurnAccelerationRadps2 = 30.0;

// Whether the step differs too much from the usual motion over `dt_s`.
bool BreaksWithin(double dt_s, const SlamStep& step, const SlamStep& usual, double times) {
  const Eigen::Vector3d off_m = step.velocity * step.duration_s - usual.velocity * dt_s;
  const Eigen::Vector3d off_rad = step.turn_rate * step.duration_s - usual.turn_rate * dt_s;
  return off_m.norm() > times * (kSlamJumpM + kAccelerationMps2 * dt_s * dt_s) ||
         off_rad.norm() > times * (2.0 * kSlamJumpRad + kTurnAccelerationRadps2 * dt_s * dt_s);
}

}  // namespace

SlamStep StepOf(const Pose3& slam_from_first, const Pose3& slam_from_second, double duration_s) {
  const Pose3 motion = Between(slam_from_first, slam_from_second);
  return {duration_s, motion.translation / duration_s, LogRotation(motion.rotation) / duration_s};
}

SlamStep UsualOf(std::span<SlamStep> steps) {
  SlamStep usual;
  if (steps.empty()) return usual;
  usual.duration_s = UpperMedianAmong(steps, [](const SlamStep& step) { return step.duration_s; });
  for (int axis = 0; axis < 3; ++axis) {
    usual.velocity[axis] =
        UpperMedianAmong(steps, [=](const SlamStep& step) { return step.velocity[axis]; });
    usual.turn_rate[axis] =
        UpperMedianAmong(steps, [=](const SlamStep& step) { return step.turn_rate[axis]; });
  }
  return usual;
}

bool BreaksMotion(const SlamStep& step, const SlamStep& usual, double times) {
  return BreaksWithin(step.duration_s, step, usual, times) &&
         BreaksWithin(std::max(step.duration_s, usual.duration_s), step, usual, times);
}

}  // namespace depthgrid
