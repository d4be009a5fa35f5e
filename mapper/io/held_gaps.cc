#include "mapper/io/held_gaps.h"

#include <algorithm>

#include "mapper/io/pose_track.h"

namespace depthgrid {
namespace {

bool IsReachable(const TimedPose& from, const TimedPose& to) {
  // Over longer stretches the way is not known, and nobody goes that fast. Chosen, not measured.
  constexpr double kMostS = 3.0, kMostMps = 2.0, kMostRadps = 2.0;
  if (!from.pose || !to.pose || from.epoch != to.epoch || from.pose == to.pose) return false;
  const double gap_s = to.stamp_s - from.stamp_s;
  const Pose3 step = Between(*from.pose, *to.pose);
  return gap_s > 0.0 && gap_s <= kMostS && step.translation.norm() <= kMostMps * gap_s &&
         AngleOf(step.rotation) <= kMostRadps * gap_s;
}

Pose3 PoseBetween(const TimedPose& from, const TimedPose& to, double stamp_s) {
  return Blend(*from.pose, *to.pose, (stamp_s - from.stamp_s) / (to.stamp_s - from.stamp_s));
}

}  // namespace

MendedPoses MendHeld(const std::vector<TimedPose>& frames, const std::vector<bool>& held) {
  MendedPoses mended;
  for (const TimedPose& frame : frames) mended.poses.push_back(frame.pose);
  for (std::size_t begin = 0; begin < frames.size(); ++begin) {
    if (!held[begin]) continue;
    std::size_t end = begin;
    while (end < frames.size() && held[end]) ++end;
    const bool mends =
        begin > 0 && end < frames.size() && IsReachable(frames[begin - 1], frames[end]);
    for (std::size_t i = begin; i < end; ++i) {
      mended.poses[i].reset();
      if (mends) mended.poses[i] = PoseBetween(frames[begin - 1], frames[end], frames[i].stamp_s);
    }
    mended.gaps.push_back({begin, end, mends});
    begin = end;
  }
  return mended;
}

HeldCount CountHeld(const std::vector<HeldGap>& gaps, const FramePart& part) {
  HeldCount count;
  for (const HeldGap& gap : gaps) {
    const std::size_t begin = std::max(gap.begin, part.begin), end = std::min(gap.end, part.end);
    if (begin >= end) continue;
    if (!count.first) count.first = begin;
    (gap.is_interpolated ? count.interpolated : count.lost) += end - begin;
  }
  return count;
}

}  // namespace depthgrid
