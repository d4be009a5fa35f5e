#include "mapper/scan/stand_drift.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// The limits are choices; docs/tried.md, "Heights and tilts", has what others gave.
// What is seen of the floor's height and tilt is uncertain by this much.
constexpr double kUnsureM = 0.05;
constexpr double kUnsureRad = RadFromDeg(1.0);
// SLAM may drift this many times as fast as it did lately, or by this much in a frame: recordings
// have .2 to .6 mm (docs/slam_surrogate.md).
constexpr double kTimesAsFast = 3.0;
constexpr double kPerFrameM = 0.0006;
constexpr double kPerFrameRad = RadFromDeg(0.02);
// A rise or fall by more in one frame is a jump of SLAM: 3 m/s at 30 Hz.
constexpr double kMostStepM = 0.1;
constexpr double kSlowRad = RadFromDeg(0.03);  // in a frame
constexpr int kFramesOfWindow = 60;
constexpr double kKeptOfRate = 0.8;  // from window to window

}  // namespace

bool StandDrift::IsSlow() const { return windows_ > 0 && rate_rad_ < kSlowRad; }

void StandDrift::Step(double rise_m) {
  most_m_ += kPerFrameM + kTimesAsFast * rate_m_;
  most_rad_ += kPerFrameRad + kTimesAsFast * rate_rad_;
  if (std::abs(rise_m) > kMostStepM) most_m_ += std::abs(rise_m);
}

void StandDrift::Seen(double height_off_m, const Eigen::Vector3d& up_off) {
  off_m_ += height_off_m;
  up_off_ += up_off;
  if (++frames_ == kFramesOfWindow) {
    rate_m_ = std::max(std::abs(off_m_) / frames_, kKeptOfRate * rate_m_);
    rate_rad_ = std::max(up_off_.norm() / frames_, kKeptOfRate * rate_rad_);
    off_m_ = 0.0;
    up_off_.setZero();
    frames_ = 0;
    ++windows_;
  }
  most_m_ = kUnsureM;
  most_rad_ = kUnsureRad;
  jumped_ = false;
}

}  // namespace depthgrid
