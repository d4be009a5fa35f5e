#include "mapper/map_joining.h"

#include <algorithm>
#include <utility>

#include "mapper/doubled_walls.h"
#include "mapper/finished_map.h"
#include "mapper/torn_map.h"

namespace depthgrid {
namespace {

// Joins made in one map at most, the share of the crossing beams that each of them may leave, and
// the share that all of them together may.
constexpr int kMostJoins = 4;
constexpr double kLeftByOne = 0.85;
constexpr double kLeftByAll = 0.5;
// Mendings that are tried, those that leave least as they are first.
constexpr std::size_t kMostTried = 3;

// The first one moves poses far, the second one is as accurate as the adjustment so far.
constexpr AdjustEffort kOfPlaces[] = {AdjustEffort::kCloseLoops, AdjustEffort::kFinish};
constexpr AdjustEffort kOfParts[] = {AdjustEffort::kFinishMoved};

}  // namespace

JoinedMap MapJoining::Examined(std::vector<MappedFrame> frames,
                               std::vector<PlanarLoop> loops) const {
  JoinedMap joined;
  joined.map = DrawKept(frames, grid_);
  joined.crossed = WallsCrossed(frames, joined.map, kDoubledSample);
  joined.frames = std::move(frames);
  joined.loops = std::move(loops);
  return joined;
}

std::optional<JoinedMap> MapJoining::Joined(const JoinedMap& map) const {
  std::optional<JoinedMap> joined;
  for (int joins = 0; joins < kMostJoins; ++joins) {
    const JoinedMap& before = joined ? *joined : map;
    if (before.share() < kDoubledShare) break;
    std::optional<JoinedMap> next = JoinedByPlace(before);
    if (!next) next = JoinedByPart(before);
    if (!next) break;
    joined = std::move(next);
  }
  if (joined && joined->share() > kLeftByAll * map.share()) return std::nullopt;
  return joined;
}

std::optional<JoinedMap> MapJoining::JoinedByPlace(const JoinedMap& map) const {
  const auto loop =
      LoopOfDoubledWalls(map.frames, map.crossed, options_.search, options_.overlap, guessed_);
  if (!loop) return std::nullopt;
  // What was mended would be torn again if it began at the poses of the run.
  std::optional<JoinedMap> joined =
      map.mended ? JoinedWith(*loop, map, kOfParts) : JoinedWith(*loop, map, kOfPlaces);
  if (joined && joined->share() > kLeftByOne * map.share()) return std::nullopt;
  return joined;
}

std::optional<JoinedMap> MapJoining::JoinedByPart(const JoinedMap& map) const {
  struct Try {
    PlanarLoop loop;
    JoinedMap moved;
  };
  std::vector<Try> tries;
  for (const Mending& mending :
       MendingsOf(map.frames, options_.search, options_.overlap, guessed_)) {
    JoinedMap moved = Examined(WithPoses(map.frames, mending.map_from_base), map.loops);
    if (moved.share() > kLeftByOne * map.share()) continue;
    tries.push_back({mending.loop, std::move(moved)});
  }
  std::stable_sort(tries.begin(), tries.end(),
                   [](const Try& a, const Try& b) { return a.moved.share() < b.moved.share(); });
  if (tries.size() > kMostTried) tries.resize(kMostTried);
  for (Try& candidate : tries) {
    candidate.moved.mended = true;
    std::optional<JoinedMap> joined = JoinedWith(candidate.loop, candidate.moved, kOfParts);
    if (joined && joined->share() <= kLeftByOne * map.share()) return joined;
  }
  return std::nullopt;
}

// Empty if an adjustment rejects the loop.
std::optional<JoinedMap> MapJoining::JoinedWith(const PlanarLoop& loop, const JoinedMap& map,
                                                std::span<const AdjustEffort> efforts) const {
  std::vector<PlanarLoop> loops = map.loops;
  loops.push_back(loop);
  loops.back().on_trial = true;
  std::vector<MappedFrame> frames = map.frames;
  Adjustment adjustment;
  for (const AdjustEffort effort : efforts) {
    adjustment = reference_.Adjust(frames, loops, effort, {});
    if (!adjustment.loop_accepted.back()) return std::nullopt;
    frames = WithPoses(std::move(frames), adjustment.map_from_base);
  }
  loops.back().on_trial = false;
  JoinedMap joined = Examined(std::move(frames), std::move(loops));
  joined.adjustment = std::move(adjustment);
  joined.mended = map.mended;
  return joined;
}

}  // namespace depthgrid
