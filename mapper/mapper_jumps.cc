// Finds jumps that nobody tells: of SLAM's poses while there were none, and of the camera from one
// frame to the next (docs/math.md, "Epochs" and "Carried elsewhere").
#include "mapper/graph/old_views.h"
#include "mapper/mapper_state.h"
#include "mapper/place_watch.h"

namespace depthgrid {
namespace {

// Gaps from which on a jump is looked for: shorter ones hide less than half a metre (slam_step.h).
constexpr double kLeastGapS = 0.2;
// A scan of which less than this share agrees with what was seen before is not there. Right places
// reached 0.82 and more, mostly 0.97 (docs/tried.md, "Lost and found").
constexpr double kContradicted = 0.8;
// The same without a gap, where the scan alone speaks for a jump (docs/tried.md, "Carried
// elsewhere").
constexpr double kCarried = 0.7;
// And the least share of its beams that end where nothing stood before (the same place).
constexpr double kLeastNearer = 0.05;
// In a finished map of which nothing, or next to nothing, is recognised: every so many such frames
// it is looked whether the map is contradicted, and after so many contradictions in a row the place
// is wrong (docs/tried.md, "Carried elsewhere").
constexpr int kJudgeEvery = 15;
constexpr int kContradictions = 2;
constexpr double kElsewhere = 0.35;

}  // namespace

// How the newest scan, at this pose, agrees with what was seen before; at a guess, since it began.
OverlapEachWay IncrementalMapper::State::SeenBeforeAt(const Pose2& map_from_base,
                                                      const FrameScans& scans) {
  const int begin = relocation.IsApart() ? relocation.first_frame() : 0;
  std::vector<MappedFrame> frames(mapped.all().begin() + begin, mapped.all().end());
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

bool IncrementalMapper::State::LooksForJumps(const FrameScans& scans) const {
  return reference && scans.matched && !mapped.empty() && !match_oracle &&
         options.loops.relocation.use;
}

// Whether so little of the scan agrees, and enough can be compared to tell.
bool IncrementalMapper::State::Contradicts(const Overlap& told, double least_agreement) const {
  return told.compared >= options.loops.overlap.min_points && told.agreement() < least_agreement;
}

// Begins an epoch at a frame whose scan contradicts SLAM's word. Where the scan agrees better with
// the motion before having gone on, it has. Returns that agreement, 0 where it has not.
double IncrementalMapper::State::BeginAtJump(const FrameScans& scans, const Pose2& told) {
  const Overlap there = SeenBeforeAt(told, scans).both();
  history.BeginEpoch();
  const Extrapolation went_on =
      Extrapolated(history, filter.map_from_slam(), options.loops.relocation.min_lost_s);
  const Overlap on = SeenBeforeAt(went_on.map_from_base, scans).both();
  if (on.compared < options.loops.overlap.min_points || on.agreement() <= there.agreement()) {
    return 0.0;
  }
  Anchor({went_on.map_from_base, went_on.sigma_share, went_on.gap_share});
  return on.agreement();
}

// If the scan after a gap shows that SLAM's poses jumped meanwhile, an epoch begins.
Prediction IncrementalMapper::State::AfterGap(const FrameScans& scans, const Prediction& prediction,
                                              FrameReport& report) {
  if (!LooksForJumps(scans) || !has_matched) return prediction;
  const std::optional<double> gap_s = GapWithinEpoch();
  if (!gap_s || *gap_s < kLeastGapS || relocation.IsUsual(ShareExplained(report))) {
    return prediction;
  }
  const StageTimer timer(clocks, report.times.match_us);
  const Overlap told = SeenBeforeAt(prediction.map_from_base, scans).both();
  if (!Contradicts(told, kContradicted)) return prediction;
  relocation.Restarted(*gap_s);
  BeginAtJump(scans, prediction.map_from_base);
  return MatchedAnew(scans.matched, report);
}

// Whether the map, which explained the scan before, explains little of this one, which contradicts
// what was seen before.
bool IncrementalMapper::State::IsSuddenlyElsewhere(const FrameScans& scans,
                                                   const Prediction& prediction, double share) {
  if (!has_matched || !CanTellSlips(options.fusion)) return false;
  if (!slips.FellSuddenly(history.newest(), share, relocation)) return false;
  const OverlapEachWay told = SeenBeforeAt(prediction.map_from_base, scans);
  if (!Contradicts(told.both(), kCarried)) return false;
  // Where a door was opened, or somebody gone, nothing stands where nothing stood before.
  const int nearer = told.of_second.compared - told.of_second.agreeing;
  return nearer >= kLeastNearer * static_cast<double>(scans.matched->beams.size());
}

// Whether what is seen has contradicted a finished map for a while: a wrong start, or a camera that
// was carried slowly. Beyond the edge of the map there is nothing to contradict.
bool IncrementalMapper::State::IsElsewhereInFixed(const FrameScans& scans,
                                                  const Prediction& prediction, double share) {
  if (!fixed_map) return false;
  if (share >= kLeastOnMap) {
    off_map = {};
    return false;
  }
  if (++off_map.frames % kJudgeEvery != 0) return false;
  // A guess is only matched with what was seen at it, a moment ago.
  if (relocation.unsettled()) return off_map.frames >= kContradictions * kJudgeEvery;
  const Overlap told = SeenBeforeAt(prediction.map_from_base, scans).both();
  off_map.contradictions = Contradicts(told, kElsewhere) ? off_map.contradictions + 1 : 0;
  return off_map.contradictions >= kContradictions;
}

// If the camera was carried elsewhere, or SLAM's poses jumped by little, an epoch begins.
Prediction IncrementalMapper::State::AfterCarrying(const FrameScans& scans,
                                                   const Prediction& prediction,
                                                   FrameReport& report) {
  if (!LooksForJumps(scans)) return prediction;
  const StageTimer timer(clocks, report.times.match_us);
  const double share = ShareExplained(report);
  if (!IsSuddenlyElsewhere(scans, prediction, share) &&
      !IsElsewhereInFixed(scans, prediction, share)) {
    return prediction;
  }
  off_map = {};
  if (BeginAtJump(scans, prediction.map_from_base) < kContradicted) {
    relocation.Carried();
    report.carried = true;
  }
  return MatchedAnew(scans.matched, report);
}

Prediction IncrementalMapper::State::MatchedAnew(const std::shared_ptr<const Scan>& scan,
                                                 FrameReport& report) {
  const Prediction placed = Predict(scan, report);
  Match(scan, placed, report);
  return placed;
}

}  // namespace depthgrid
