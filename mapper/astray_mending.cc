#include "mapper/astray_mending.h"

#include <algorithm>
#include <utility>

#include "mapper/graph/old_views.h"
#include "mapper/graph/place.h"

namespace depthgrid {
namespace {

// Parts of a map that are examined.
constexpr int kMostExamined = 10;
// What was seen before and after a part, within this distance, from so many frames at most.
constexpr double kSeenWithinM = 12.0;
constexpr int kMostViews = 100;
// By how much the share of points that contradict each other may rise where SLAM is followed,
// before an adjustment and after it, and that of beams through walls.
constexpr double kMoreContradictedMoved = 0.02;
constexpr double kMoreContradicted = 0.005;
constexpr double kMoreCrossing = 0.005;
// An adjustment that takes back more than this share of the way finds that SLAM was wrong.
constexpr double kTakenBack = 0.5;

// Of what was seen before the part and what was seen after it.
Overlap OverlapAcross(const std::vector<MappedFrame>& frames, const AstrayPart& part,
                      const OverlapOptions& options) {
  const Pose2& after = PoseAt(frames, part.last);
  const int end = static_cast<int>(frames.size());
  const std::vector<int> old_views =
      EvenlySpread(OldFrames(frames, part.first + 1, after, kSeenWithinM), kMostViews);
  const std::vector<int> new_views =
      EvenlySpread(ViewsWithin(frames, part.last, end, after, kSeenWithinM), kMostViews);
  if (old_views.empty() || new_views.empty()) return {};
  return OverlapOf(SeenFrom(frames, old_views, part.first, options),
                   SeenFrom(frames, new_views, part.last, options),
                   Between(PoseAt(frames, part.first), after));
}

double Contradicted(const Overlap& overlap) {
  return overlap.compared == 0 ? 0.0 : 1.0 - overlap.agreement();
}

Pose2 MotionOver(const std::vector<MappedFrame>& frames, const AstrayPart& part) {
  return Between(PoseAt(frames, part.first), PoseAt(frames, part.last));
}

std::vector<MappedFrame> WithSlamFollowed(const std::vector<MappedFrame>& frames,
                                          const AstrayPart& part) {
  std::vector<MappedFrame> moved = WithPoses(frames, FollowingSlam(frames, part));
  for (int i = part.first + 1; i <= part.last; ++i) {
    moved[static_cast<std::size_t>(i)].led_astray = true;
  }
  return moved;
}

}  // namespace

std::optional<AstrayPart> AstrayMending::Next(const JoinedMap& map) const {
  std::optional<AstrayPart> next;
  for (const AstrayPart& part : AstrayPartsOf(map.frames, options_.astray_ratio)) {
    const bool known = std::any_of(examined_.begin(), examined_.end(),
                                   [&](const AstrayPart& other) { return part.Overlaps(other); });
    if (!known && (!next || part.apart_m > next->apart_m)) next = part;
  }
  return next;
}

AstrayMending::Verdict AstrayMending::Judge(const AstrayPart& part, JoinedMap& map) const {
  const std::vector<MappedFrame> moved = WithSlamFollowed(map.frames, part);
  const Overlap overlap_now = OverlapAcross(map.frames, part, options_.overlap);
  const Overlap overlap_moved = OverlapAcross(moved, part, options_.overlap);
  const int fewest = options_.overlap.min_points;
  if (overlap_now.compared < fewest || overlap_moved.compared < fewest) return Verdict::kUndecided;
  const double now = Contradicted(overlap_now);
  if (Contradicted(overlap_moved) > now + kMoreContradictedMoved) return Verdict::kSlamIsWrong;

  Adjustment adjustment = reference_.Adjust(moved, map.loops, AdjustEffort::kFinishMoved, {});
  JoinedMap mended = joining_.Examined(WithPoses(moved, adjustment.map_from_base), map.loops);
  mended.mended = true;
  mended.adjustment = std::move(adjustment);
  const Pose2 way = MotionOver(mended.frames, part);
  const double to_slam = Separation(way, MotionOver(moved, part));
  if (to_slam > kTakenBack * Separation(MotionOver(map.frames, part), MotionOver(moved, part))) {
    return Verdict::kSlamIsWrong;
  }
  if (Contradicted(OverlapAcross(mended.frames, part, options_.overlap)) >
          now + kMoreContradicted ||
      mended.share() > map.share() + kMoreCrossing) {
    return Verdict::kUndecided;
  }
  map = std::move(mended);
  return Verdict::kFollowSlam;
}

JoinedMap AstrayMending::Mended(JoinedMap map) {
  undecided_.clear();
  for (int i = 0; i < kMostExamined; ++i) {
    const std::optional<AstrayPart> part = Next(map);
    if (!part) break;
    const Verdict verdict = Judge(*part, map);
    if (verdict == Verdict::kUndecided) undecided_.push_back(*part);
    examined_.push_back(*part);
  }
  return map;
}

}  // namespace depthgrid
