// Whether a step of SLAM's poses is a motion, or a correction of SLAM that nothing drove.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "mapper/core/angle.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// From one pose of SLAM to the next, as speeds in axes of the first.
struct SlamStep {
  double duration_s = 0.0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  // rad/s
};

// `duration_s` above zero.
SlamStep StepOf(const Pose3& slam_from_first, const Pose3& slam_from_second, double duration_s);

// How far a step of ORB-SLAM2 and Planar-SLAM is off without an event: up to 0.065 m were measured,
// and 0.15 to 0.38 m where a loop or relocalisation moved the poses.
constexpr double kSlamJumpM = 0.1;
constexpr double kSlamJumpRad = RadFromDeg(4.0);

// The medians of steps, by which another one is judged; of none zero. Reorders the steps.
SlamStep UsualOf(std::span<SlamStep> steps);

// What no robot, car or hand does between two poses, however far apart in time they are.
constexpr double kLongestStepM = 10.0;
constexpr double kFastestMps = 50.0;
inline bool IsTooFar(double step_m, double duration_s) {
  return step_m > std::max(kLongestStepM, kFastestMps * duration_s);
}

// Whether the usual motion around a step does not lead where it goes, with what a hand or robot can
// change of its speed meanwhile; neither in the step's own time nor, as stamps come bunched, in a
// usual one's. `times` as far off, where little is known of what is usual.
bool BreaksMotion(const SlamStep& step, const SlamStep& usual, double times = 1.0);

}  // namespace depthgrid
