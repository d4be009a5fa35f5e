#include "mapper/core/standing.h"

#include "mapper/core/frame_report.h"

namespace depthgrid {
namespace {

// SLAM's motion, of the base or of a point 3 m away, beyond which it has left its place: ten times
// the jitter in the last digits of odometry, a tenth of the motion per frame at walking pace.
constexpr double kLeftM = 0.005;
// The same for matched poses, which are noisier; better matches give no information on SLAM's
// errors (motion_noise.cc).
constexpr double kSeenToLeaveM = 0.05;
// And for so many frames in a row, if SLAM's poses ever moved. Measured: docs/tried.md, "People
// around a robot that stands".
constexpr int kSeenFrames = 5;

bool IsFarther(const Pose2& motion, double limit_m) {
  return motion.vector().cwiseQuotient(kMotionUnit).norm() > limit_m;
}

}  // namespace

bool Standing::After(const Pose2& motion) const {
  return frames_ + 1 >= kMovingFrames && !IsFarther(since_left_ * motion, kLeftM);
}

void Standing::Add(const Pose2& motion, const std::optional<Pose2>& map_from_base) {
  if (frames_ < kMovingFrames) ++frames_;
  since_left_ = since_left_ * motion;
  if (IsFarther(since_left_, kLeftM)) {
    since_left_ = {};
    frames_ = 0;
    seen_ = map_from_base;
    elsewhere_ = 0;
    ever_left_ = true;
    return;
  }
  if (!map_from_base) return;
  if (!seen_) seen_ = map_from_base;
  elsewhere_ = IsFarther(Between(*seen_, *map_from_base), kSeenToLeaveM) ? elsewhere_ + 1 : 0;
  if (elsewhere_ < (ever_left_ ? kSeenFrames : 1)) return;
  frames_ = 0;
  seen_ = map_from_base;
  elsewhere_ = 0;
}

}  // namespace depthgrid
