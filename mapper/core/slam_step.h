// Whether a step between SLAM poses is a physical motion or a correction of SLAM.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "mapper/core/angle.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// A step from one SLAM pose to the next, as velocities in axes of the first.
struct SlamStep {
  double duration_s = 0.0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  // rad/s
};

// `duration_s` above zero.
SlamStep StepOf(const Pose3& slam_from_first, const Pose3& slam_from_second, double duration_s);

// Error of a step above which SLAM corrected itself. Measured for ORB-SLAM2 and Planar-SLAM: up to
// 0.065 m without an event, 0.15 to 0.38 m where a loop or relocalisation moved the poses.
constexpr double kSlamJumpM = 0.1;
constexpr double kSlamJumpRad = RadFromDeg(4.0);

// The medians of the steps' components, to judge another step by; zero for no steps. Reorders them.
SlamStep UsualOf(std::span<SlamStep> steps);

// Steps longer than both are no motion of a robot, car or hand, whatever their duration.
constexpr double kLongestStepM = 10.0;
constexpr double kFastestMps = 50.0;
inline bool IsTooFar(double step_m, double duration_s) {
  return step_m > std::max(kLongestStepM, kFastestMps * duration_s);
}

// Whether a step deviates from the usual motion by more than a hand or robot can accelerate, for
// both the step's own duration and the usual one (stamps may come bunched). `times` scales the
// limits, where little is known of the usual motion.
bool BreaksMotion(const SlamStep& step, const SlamStep& usual, double times = 1.0);

}  // namespace depthgrid
