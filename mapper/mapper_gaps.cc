// Finds jumps of SLAM's poses that happened while there were none (docs/math.md, "Epochs").
#include "mapper/graph/old_views.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

// Gaps from which on a jump is looked for: shorter ones hide less than half a metre (slam_step.h).
constexpr double kLeastGapS = 0.2;
// A scan of which less than this share agrees with what was seen before is not there. Right places
// reached 0.82 and more, mostly 0.97 (docs/tried.md, "Lost and found").
constexpr double kContradicted = 0.8;

}  // namespace

// How the newest scan, at this pose, agrees with what was seen before.
Overlap IncrementalMapper::State::SeenBeforeAt(const Pose2& map_from_base,
                                               const FrameScans& scans) {
  std::vector<MappedFrame> frames = mapped.all();
  frames.push_back(mapped.WithScans(AsMapped(map_from_base, 1.0), scans));
  return OverlapOfNewest(frames, options.loops.overlap);
}

// Seconds without a pose before the newest frame, if SLAM goes on in the same epoch after them.
std::optional<double> IncrementalMapper::State::GapWithinEpoch() const {
  if (!history.WasLost() && !history.HadPause()) return std::nullopt;
  const FrameRecord& before = *history.PosedBefore(history.newest());
  if (before.epoch != history.newest().epoch) return std::nullopt;
  return history.newest().stamp_s - before.stamp_s;
}

// If the scan after a gap shows that SLAM's poses jumped meanwhile, an epoch begins. The motion
// before the gap has gone on where that explains the scan better than SLAM's word.
Prediction IncrementalMapper::State::AfterGap(const FrameScans& scans, const Prediction& prediction,
                                              FrameReport& report) {
  if (!reference || !scans.matched || mapped.empty() || match_oracle || !has_matched ||
      !options.loops.relocation.use) {
    return prediction;
  }
  const std::optional<double> gap_s = GapWithinEpoch();
  const double share = report.match.found ? report.match.score : 0.0;
  if (!gap_s || *gap_s < kLeastGapS || relocation.IsUsual(share)) return prediction;
  const StageTimer timer(clocks, report.times.match_us);
  const int least = options.loops.overlap.min_points;
  const Overlap told = SeenBeforeAt(prediction.map_from_base, scans);
  if (told.compared < least || told.agreement() >= kContradicted) return prediction;
  history.BeginEpoch();
  relocation.Restarted(*gap_s);
  const Extrapolation went_on =
      Extrapolated(history, filter.map_from_slam(), options.loops.relocation.min_lost_s);
  const Overlap on = SeenBeforeAt(went_on.map_from_base, scans);
  if (on.compared >= least && on.agreement() > told.agreement()) {
    Anchor({went_on.map_from_base, went_on.sigma_share, went_on.gap_share});
  }
  const Prediction placed = Predict(scans.matched, report);
  Match(scans.matched, placed, report);
  return placed;
}

}  // namespace depthgrid
