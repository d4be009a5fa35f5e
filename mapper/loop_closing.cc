#include "mapper/loop_closing.h"

#include <optional>
#include <utility>

#include "mapper/mapped_frames.h"

namespace depthgrid {

std::vector<PlanarLoop> Held(const std::vector<PlanarLoop>& loops, const Adjustment& adjustment) {
  std::vector<PlanarLoop> held;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (adjustment.loop_accepted[i]) held.push_back(loops[i]);
  }
  return held;
}

void LoopOptions::Visit(OptionsVisitor& v) {
  v.Flag("use", use, "whether SLAM's loops correct the map");
  v.Flag("verify", verify, "whether a loop must make what its two places saw agree");
  v.Group("overlap", overlap, "how that is tested");
  v.Number("bend_frames", bend_frames, {0, 1e9},
           "with more mapped frames, loops only bend the path until all is adjusted at the end");
  v.Group("search", search, "loops that the mapper finds itself");
  v.Flag("join_doubled", join_doubled,
         "whether what the finished map shows twice is joined, where search.use is on");
  v.Number("astray_ratio", astray_ratio, {0.0, 1e6},
           "where the finished map leaves SLAM's path by this many times as much as usual and "
           "nothing seen contradicts SLAM, SLAM is followed; 0: nowhere");
  v.Group("slide", slide, "where the estimate is after a stretch that told little of it");
  v.Group("relocation", relocation, "where the camera is after SLAM was lost for seconds");
}

AdjustEffort LoopCloser::EffortFor(const std::vector<MappedFrame>& frames,
                                   AdjustEffort wanted) const {
  return static_cast<int>(frames.size()) > options_.bend_frames ? AdjustEffort::kBend : wanted;
}

LoopCloser::Outcome LoopCloser::Close(const std::vector<LoopClosure>& events,
                                      const FrameHistory& history,
                                      const std::vector<MappedFrame>& frames, bool newest_is_last,
                                      ReferenceMap& reference, std::span<const int> asked) {
  Outcome outcome;
  if (!options_.use) return outcome;
  const int newest_mapped = newest_is_last ? static_cast<int>(frames.size()) - 1 : -1;
  const std::size_t known = loops_.size();
  std::vector<LoopClosure> due = std::exchange(waiting_, {});
  due.insert(due.end(), events.begin(), events.end());
  for (const LoopClosure& event : due) {
    std::optional<PlanarLoop> loop = ProjectLoop(event, history, newest_mapped);
    if (!loop && MayBeProjectedLater(event, history)) waiting_.push_back(event);
    if (!loop) continue;
    loop = BetweenKept(*loop, frames);
    if (!loop) continue;
    if (options_.verify && !Agrees(OverlapOf(frames, *loop, options_.overlap), options_.overlap)) {
      continue;
    }
    loops_.push_back(*loop);
  }
  if (loops_.size() > known) {
    const AdjustEffort effort = EffortFor(frames, AdjustEffort::kCloseLoops);
    Adjustment adjustment = reference.Adjust(frames, loops_, effort, asked);
    outcome.adjusted = true;
    outcome.map_from_base = std::move(adjustment.map_from_base);
    outcome.covariance = std::move(adjustment.covariance);
    outcome.held = Held(loops_, adjustment);
    for (std::size_t i = known; i < loops_.size(); ++i) {
      outcome.accepted += adjustment.loop_accepted[i] ? 1 : 0;
    }
  }
  outcome.rejected = static_cast<int>(due.size() - waiting_.size()) - outcome.accepted;
  return outcome;
}

LoopCloser::Outcome LoopCloser::Add(const std::vector<PlanarLoop>& found,
                                    const std::vector<MappedFrame>& frames, AdjustEffort wanted,
                                    ReferenceMap& reference, std::span<const int> asked) {
  const std::vector<PlanarLoop> known = loops_;
  for (const PlanarLoop& loop : found) {
    const std::optional<PlanarLoop> kept = BetweenKept(loop, frames);
    if (!kept) continue;
    loops_.push_back(*kept);
    loops_.back().on_trial = true;
  }
  Outcome outcome;
  outcome.rejected = static_cast<int>(found.size());
  if (loops_.size() == known.size()) return outcome;
  const Adjustment adjustment = reference.Adjust(frames, loops_, EffortFor(frames, wanted), asked);
  const auto pose = [&](int frame) {
    return adjustment.map_from_base[static_cast<std::size_t>(frame)];
  };
  bool believed = true;
  for (std::size_t i = known.size(); i < loops_.size(); ++i) {
    PlanarLoop adjusted = loops_[i];
    adjusted.first_from_second = Between(pose(adjusted.first), pose(adjusted.second));
    believed = believed && adjustment.loop_accepted[i] &&
               Agrees(OverlapOf(frames, adjusted, options_.overlap), options_.overlap);
  }
  if (!believed) {
    loops_ = known;
    return outcome;
  }
  outcome.adjusted = true;
  outcome.map_from_base = adjustment.map_from_base;
  outcome.covariance = adjustment.covariance;
  outcome.accepted = static_cast<int>(loops_.size() - known.size());
  outcome.rejected -= outcome.accepted;
  outcome.held = Held(loops_, adjustment);
  for (PlanarLoop& loop : loops_) loop.on_trial = false;
  return outcome;
}

}  // namespace depthgrid
