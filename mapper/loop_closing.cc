#include "mapper/loop_closing.h"

#include <utility>

namespace depthgrid {

void LoopOptions::Visit(OptionsVisitor& v) {
  v.Flag("use", use, "whether SLAM's loops correct the map");
  v.Flag("verify", verify, "whether a loop must lay what its two places saw over each other");
  v.Group("overlap", overlap, "how that is tested");
}

LoopCloser::Outcome LoopCloser::Close(const std::vector<LoopClosure>& events,
                                      const FrameHistory& history,
                                      const std::vector<MappedFrame>& frames, bool newest_is_last,
                                      ReferenceMap& reference) {
  Outcome outcome;
  if (!options_.use || events.empty()) return outcome;
  const int newest_mapped = newest_is_last ? static_cast<int>(frames.size()) - 1 : -1;
  const std::size_t known = loops_.size();
  for (const LoopClosure& event : events) {
    const std::optional<PlanarLoop> loop = ProjectLoop(event, history, newest_mapped);
    if (!loop) continue;
    if (options_.verify && !Agrees(OverlapOf(frames, *loop, options_.overlap), options_.overlap)) {
      continue;
    }
    loops_.push_back(*loop);
  }
  if (loops_.size() > known) {
    Adjustment adjustment = reference.Adjust(frames, loops_, AdjustEffort::kCloseLoops);
    outcome.adjusted = true;
    outcome.map_from_base = std::move(adjustment.map_from_base);
    for (std::size_t i = known; i < loops_.size(); ++i) {
      outcome.accepted += adjustment.loop_accepted[i] ? 1 : 0;
    }
  }
  outcome.rejected = static_cast<int>(events.size()) - outcome.accepted;
  return outcome;
}

}  // namespace depthgrid
