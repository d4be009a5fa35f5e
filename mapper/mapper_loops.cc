// Loops that the mapper finds itself.
#include "mapper/mapper_state.h"

namespace depthgrid {

bool IncrementalMapper::State::SearchesSlides() const {
  return options.loops.slide.use && options.method == MapperMethod::kSurfel && reference &&
         !fixed_map && !match_oracle && !relocation.doubts();
}

// Whether the estimate slid along a wall: another pose along it is tried before this one is used.
void IncrementalMapper::State::LookForSlide(const std::shared_ptr<const Scan>& scan,
                                            const Prediction& prediction, FrameReport& report) {
  if (!SearchesSlides() || !scan || !report.match.found) return;
  const Pose2 matched = report.match.map_from_base;
  if (!slides.Wants(matched)) return;
  {
    const StageTimer timer(clocks, report.times.loops_us);
    slides.Look(scan, matched, relocation.usual_share(), *reference);
  }
  Match(scan, prediction, report);
}

IncrementalMapper::State::FoundLoops IncrementalMapper::State::LoopsFound(
    const FrameScans& scans, const FrameReport& report) {
  if (SearchesSlides()) {
    const auto slide = slides.Mapped(mapped.all(), report.covariance);
    // It bends the last seconds: all else lies as well as it did.
    if (slide) return {{*slide}, AdjustEffort::kRefine};
  }
  if (!loop_search) return {};
  return {loop_search->Find(mapped.all(), scans.matched, loop_closer.loops(), *reference),
          AdjustEffort::kCloseLoops};
}

// The frame's reported estimate is not changed.
void IncrementalMapper::State::FindLoops(const FrameScans& scans, FrameReport& report) {
  const StageTimer timer(clocks, report.times.loops_us);
  if (fixed_map || !(report.inserted || report.well_seen)) return;
  const FoundLoops found = LoopsFound(scans, report);
  if (found.loops.empty()) return;
  const LoopCloser::Outcome outcome =
      loop_closer.Add(found.loops, mapped.all(), found.effort, *reference, errors.Mapped());
  report.loops_accepted += outcome.accepted;
  report.loops_rejected += outcome.rejected;
  if (loop_search) loop_search->Forget();
  relocation.Joined(outcome.held);
  if (outcome.adjusted) MoveTo(outcome.map_from_base, outcome.covariance);
}

}  // namespace depthgrid
