#include "mapper/incremental_mapper.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/frame_check.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

int HitCount(const Scan& scan) {
  return static_cast<int>(std::count_if(scan.beams.begin(), scan.beams.end(),
                                        [](const Beam& beam) { return beam.hit; }));
}

// Accuracy of the start in a prior map: m, m, rad. SLAM's own frame may be off by more.
const Eigen::Vector3d kStartSigma(0.05, 0.05, 0.03);

}  // namespace

IncrementalMapper::IncrementalMapper(const MapperOptions& options,
                                     const std::optional<PinholeCamera>& camera, FrameClocks clocks,
                                     GainOracle oracle) {
  RequireInRange(options, "mapper");
  if (camera) Validate(*camera, "camera");
  state_ = std::make_unique<State>(options, camera, std::move(clocks), std::move(oracle));
  if (options.fusion.mode == FusionMode::kOracle && !state_->oracle) {
    throw SettingError("mapper.fusion.mode",
                       "is oracle, must be another one: only an experiment knows the truth");
  }
}
IncrementalMapper::~IncrementalMapper() = default;
IncrementalMapper::IncrementalMapper(IncrementalMapper&&) noexcept = default;
IncrementalMapper& IncrementalMapper::operator=(IncrementalMapper&&) noexcept = default;

void IncrementalMapper::SetMatchOracle(MatchOracle oracle) {
  if (oracle) state_->beginning.End();
  state_->match_oracle = std::move(oracle);
}

FrameReport IncrementalMapper::AddFrame(const Frame& frame) {
  RequireSound(frame, state_->camera);
  FrameReport report;
  {
    const FrameTimer total(state_->clocks, report.times);  // writes the times on destruction
    state_->Map(state_->Believed(frame), report);
  }
  return report;
}

// Without a pose that is held, or a scan that is frozen; a pose that repeats as odometry is slower
// than the scans is moved on.
Frame IncrementalMapper::State::Believed(const Frame& frame) {
  Frame believed = frame;
  if (frozen.IsFrozen(frame)) {
    believed.scan.reset();
    believed.matched_scan.reset();
    believed.stand.reset();
  }
  if (!reference) return believed;
  if (held.IsHeld(frame)) {
    believed.slam_from_camera.reset();
    if (const FrameRecord* first = history.Find(held.first_frame())) TakeBackSince(*first);
  } else if (const std::optional<Pose3> moved_on = held.MovedOn()) {
    believed.slam_from_camera = moved_on;
    // Older ones are asked for only where the first frames are mapped again.
    if (!beginning.lasts()) moved_on_frames.clear();
    moved_on_frames.push_back(frame.index);
  }
  return believed;
}

// SLAM's next motion begins at the first frame with the held pose: what the frames since were
// matched by is no correction of it.
void IncrementalMapper::State::TakeBackSince(const FrameRecord& first) {
  if (!first.slam_from_camera || first.mapped < 0 || !history.newest().slam_from_camera) return;
  const MappedFrame& frame = mapped.all()[static_cast<std::size_t>(first.mapped)];
  filter.SetCorrection(frame.map_from_base * Inverse(BaseOf(*first.slam_from_camera)));
}

// The paper's Fig. 1.
void IncrementalMapper::State::Map(const Frame& frame, FrameReport& report) {
  Begin(frame, report);
  const FrameScans scans = ScansOf(frame, report);
  TakeOutMistaken(frame, report);
  MapScans(frame, scans, report);
  beginning.Add(frame, scans);
  TellCorrections(report);
}

void IncrementalMapper::State::MapScans(const Frame& frame, const FrameScans& scans,
                                        FrameReport& report) {
  if (scans.matched) report.beams = HitCount(*scans.matched);
  CloseLoops(frame, scans, report);
  if (!frame.slam_from_camera) return;  // SLAM is lost: no estimate
  Prediction prediction = Predict(scans.matched, report);
  // A depth camera's noise is taken for people (docs/tried.md, "What moves").
  if (scans.stand) prediction.motion_covariance.reset();
  Match(scans.matched, prediction, report);
  prediction = AfterGap(scans, prediction, report);
  prediction = AfterSlip(scans, prediction, report);
  LookForSlide(scans.matched, prediction, report);
  DoubtGuess(report);
  const FusedPose fused = Fuse(prediction, report);
  Insert(scans, prediction, fused, report);
  Relocate(scans, report);
  FindLoops(scans, report);
  report.guessed = relocation.unsettled();
  if (fixed_map) report.inserted = report.well_seen = false;
}

void IncrementalMapper::State::Begin(const Frame& frame, FrameReport& report) {
  const bool is_told = std::find(moved_on_frames.begin(), moved_on_frames.end(), frame.index) ==
                       moved_on_frames.end();
  history.Start(frame, is_told);
  moves = {};
  report.index = frame.index;
  report.stamp_s = frame.stamp_s;
  report.slam_from_camera = frame.slam_from_camera;
  report.slam_epoch = frame.slam_epoch;
  report.map_from_slam = prior_start.value_or(filter.map_from_slam());
}

FrameScans IncrementalMapper::State::ScansOf(const Frame& frame, FrameReport& report) {
  const StageTimer timer(clocks, report.times.scan_us);
  FrameScans scans = scanner.ScansOf(frame);
  if (reference && scans.matched && frame.slam_from_camera) {
    moving.Follow(static_cast<int>(history.records().size()) - 1, *scans.matched,
                  BaseOf(*frame.slam_from_camera), history.newest().epoch);
    moving.TakeOut(scans);
  }
  report.stand = scans.stand;
  const bool follows_floor = options.scan.floor == FloorSource::kImage;
  // With SLAM trusted alone its poses are not changed.
  if (follows_floor && scans.stand && frame.slam_from_camera && !options.fusion.TrustsSlamAlone()) {
    history.newest().stand = scans.stand;
    stands.Add(*frame.slam_from_camera, *scans.stand);
  }
  return scans;
}

// Handles loops before the frame's pose is used. SLAM's own correction (a new epoch) is not
// adopted: the loops correct the map, and the frame is placed by its own loop or else by the
// previous motion.
void IncrementalMapper::State::CloseLoops(const Frame& frame, const FrameScans& scans,
                                          FrameReport& report) {
  const StageTimer timer(clocks, report.times.loops_us);
  if (!reference) return;
  if (mapped.empty() || mapped.back().of_prior_map() || fixed_map) {
    report.loops_rejected = static_cast<int>(frame.loops.size());
    return;
  }
  if (frame.loops.empty() && !loop_closer.waits()) {
    if (rounds.BeginIfDue(mapped.size() - mapped.standing() - prior_frames)) {
      const std::optional<MotionSpread> spread = AdjustBetweenFrames();
      if (spread && beginning.lasts() && AwaitsSpread()) GoThroughAgain(frame, *spread);
    }
    return;
  }
  std::vector<MappedFrame> frames = mapped.all();
  const bool provisional = scans.matched && frame.slam_from_camera;
  EpochStart start;
  if (provisional) {
    start = SameEpoch() ? EpochStart{CarriedOn(), 0.0, 0.0} : BegunAt(nullptr);
    const double variance = gap_variance + start.gap_share * start.gap_share;
    frames.push_back(mapped.WithScans(AsMapped(start.map_from_base, variance), scans));
  }
  LoopCloser::Outcome outcome =
      loop_closer.Close(frame.loops, history, frames, provisional, *reference, errors.Mapped());
  report.loops_accepted = outcome.accepted;
  report.loops_rejected = outcome.rejected;
  relocation.Joined(outcome.held);
  if (!outcome.adjusted) return;
  const Pose2 newest = outcome.map_from_base.back();
  outcome.map_from_base.resize(mapped.all().size());
  MoveTo(outcome.map_from_base, outcome.covariance);
  if (provisional) Anchor({newest, 0.0, start.gap_share});
}

// Adjusts poses and map during the run; returns SLAM's noise if it could be estimated.
std::optional<MotionSpread> IncrementalMapper::State::AdjustBetweenFrames() {
  const Adjustment adjustment =
      loop_closer.AdjustAll(mapped.all(), *reference, AdjustEffort::kRefine, errors.Mapped());
  MoveTo(adjustment.map_from_base, adjustment.covariance);
  const std::optional<MotionSpread>& spread = adjustment.motion_spread;
  if (spread && spread->IsSure()) filter.BoundMotion(*spread);
  return spread;
}

// The first scan after a loss, or a pause, decides whether the guess is doubted.
void IncrementalMapper::State::DoubtGuess(const FrameReport& report) {
  if (!reference || mapped.empty()) return;
  if (history.WasLost() || history.HadPause()) {
    const FrameRecord& before = *history.PosedBefore(history.newest());
    if (fixed_map && !relocation.unsettled()) {
      relocation.LastKnownAt(before.map_from_slam * BaseOf(*before.slam_from_camera));
    }
    const Pose2 step =
        Between(BaseOf(*before.slam_from_camera), BaseOf(*history.newest().slam_from_camera));
    const double duration_s = report.stamp_s - before.stamp_s;
    if (history.RestartedAfterLoss()) relocation.Restarted(duration_s);
    if (history.HadPause()) {
      relocation.Paused(duration_s, step);
    } else if (before.epoch != history.newest().epoch || history.OutranUsualMotion()) {
      relocation.Lost(duration_s, step);
    } else {
      relocation.Lost(duration_s, std::nullopt);
    }
  }
  if (report.beams == 0) return;  // without returns there is nothing to judge by
  double share = ShareExplained(report);
  if (fixed_map && relocation.BeginsAgain()) {
    GiveGuessUp();
    share = 0.0;
  }
  if (relocation.BeginIfDoubtful(share, mapped.size())) {
    if (relocation.doubts()) reference->BeginPart(PartPlace::kGuessed);
  } else if (report.match.found) {
    relocation.Explained(share);
  }
}

// Predicts with SLAM's motion; first places a new epoch or the start in a prior map.
Prediction IncrementalMapper::State::Predict(const std::shared_ptr<const Scan>& scan,
                                             FrameReport& report) {
  const StageTimer timer(clocks, report.times.match_us);
  const FrameRecord& record = history.newest();
  const Pose2 slam_from_base = BaseOf(*record.slam_from_camera);
  filter.SetFrames(history.FramesToNewest(), history.UsualStepBeforeNewest());
  if (reference && !SameEpoch()) BeginEpoch(scan);
  filter_epoch = record.epoch;
  if (prior_start) {
    filter.Restart(slam_from_base, record.stamp_s, *prior_start * slam_from_base,
                   Squared(kStartSigma));
    prior_start.reset();
  }
  return filter.Predict(slam_from_base, record.stamp_s);
}

void IncrementalMapper::State::Match(const std::shared_ptr<const Scan>& scan,
                                     const Prediction& prediction, FrameReport& report) {
  const StageTimer timer(clocks, report.times.match_us);
  if (!reference || !scan || mapped.empty()) return;
  report.match = reference->Match(scan, prediction);
  if (match_oracle && report.match.found) {
    report.match.map_from_base = match_oracle(report.index);
  }
  report.match.information = InformationFor(prediction, report.match, options.fusion.tilt_rad);
}

// Eq. 3.
FusedPose IncrementalMapper::State::Fuse(const Prediction& prediction, FrameReport& report) {
  const StageTimer timer(clocks, report.times.fuse_us);
  FrameRecord& record = history.newest();
  Eigen::Vector3d outside_gain = Eigen::Vector3d::Zero();
  if (oracle && report.match.found) {
    outside_gain = oracle(record.index, prediction.map_from_base, report.match.map_from_base);
    Require(outside_gain.allFinite(), "an oracle's gain is made of finite numbers");
  }
  const FusedPose fused =
      filter.Fuse(BaseOf(*record.slam_from_camera), prediction, report.match, outside_gain);
  filter.Commit(BaseOf(*record.slam_from_camera), record.stamp_s, fused.map_from_base,
                fused.covariance);
  record.map_from_slam = filter.map_from_slam();
  report.map_from_slam = filter.map_from_slam();
  report.map_from_camera = CameraPose(record, filter.map_from_slam(), stands);
  for (int axis = 0; axis < 3; ++axis) {
    report.innovation[static_cast<std::size_t>(axis)] = fused.innovation[axis];
    report.gain[static_cast<std::size_t>(axis)] = fused.gain(axis, axis);
  }
  report.covariance = fused.covariance;
  report.innovation_chi2 = fused.innovation_chi2;
  report.innovation_rejected = fused.rejected;
  if (reference) TellMotion(fused, report);
  return fused;
}

void IncrementalMapper::State::TellMotion(const FusedPose& fused, FrameReport& report) {
  const bool taken = report.match.found && !fused.rejected;
  has_matched = has_matched || taken;
  errors.Add(
      filter.step(), report.index, static_cast<int>(mapped.size()),
      report.match.information / (options.fusion.match_overconfidence * match_noise.factor()),
      taken ? reference->MatchedParts() : std::span<const MapPart>(),
      report.stand ? LastingErrorOfCamera(options.fusion.lasting_share) : LastingError());
  if (errors.innovation_covariance()) {
    const InnovationSize size =
        SeenSize(*errors.innovation_covariance(), report.match.information, fused.innovation);
    report.innovation_chi2 = size.chi2;
    filter.AddInnovation(fused.innovation, size.weight);
    if (options.fusion.JudgesInnovations()) match_noise.Add(size);
  }
  report.motion_from = errors.motion_from();
  report.motion_covariance = errors.MotionCovariance(fused.map_from_base);
}

void IncrementalMapper::State::Insert(const FrameScans& scans, const Prediction& prediction,
                                      const FusedPose& fused, FrameReport& report) {
  const StageTimer timer(clocks, report.times.insert_us);
  if (!scans.matched || (fixed_map && !relocation.unsettled()) || !IsOnAMap(fused.map_from_base))
    return;
  MappedFrame frame = AsMapped(fused.map_from_base, gap_variance);
  frame.match = report.match;
  // In a report it is in axes of the predicted pose.
  frame.match.information =
      InformationIn(report.match.map_from_base,
                    {report.match.found, prediction.map_from_base, report.match.information});
  history.newest().mapped = mapped.size();
  // Without matching (SLAM trusted alone) scans count as explained.
  std::optional<double> explained = 1.0;
  if (reference) explained = ShareExplained(report);
  // Frames that loops refer to are always kept.
  const bool ends_loops = report.loops_accepted + report.loops_rejected > 0;
  if (ends_loops) explained.reset();
  // Until the place after a loss is known, do not tie to frames from before it.
  const int from = relocation.unsettled() ? relocation.first_frame() : 0;
  const bool matches = reference && report.match.found;
  const auto matched = matches ? reference->MatchedParts() : std::span<const MapPart>();
  const MappedFrame& added = mapped.Add(std::move(frame), scans, explained, matched, from);
  gap_variance = 0.0;
  report.inserted = added.kept();
  report.well_seen = !added.kept();
  if (!reference) return;
  // Groups do not reach across a gap: loops may open it, nothing else may give way in its place.
  if (!added.slam_motion) reference->BeginPart(PartPlace::kKnown);
  if (added.kept()) {
    const FilterStep& step = filter.step();
    if (added.slam_motion) {
      reference->Corrected(
          step.previous, step.previous * Pose2::FromVector(step.previous_gain * fused.innovation));
    }
    reference->Insert(scans.kept(), fused.map_from_base, fused.covariance);
  } else {
    reference->InsertTied(scans.matched, fused.map_from_base, added.tied_to);
  }
}

MappedFrame IncrementalMapper::State::AsMapped(const Pose2& map_from_base, double variance) const {
  const FrameRecord& record = history.newest();
  MappedFrame frame;
  frame.frame = record.index;
  frame.stamp_s = record.stamp_s;
  frame.map_from_base = map_from_base;
  // If the guess after a loss is doubted, SLAM's motion over it is not used.
  const bool doubted = relocation.doubts() && mapped.size() == relocation.first_frame();
  if (!doubted && !mapped.empty() && !mapped.back().of_prior_map()) {
    const FrameRecord& before = *history.Find(mapped.back().frame);
    if (before.epoch == record.epoch) {
      frame.slam_motion =
          Between(BaseOf(*before.slam_from_camera), BaseOf(*record.slam_from_camera));
    } else {
      // From one frame to the next the last motion goes on; else the longer, the less is known.
      const bool went_on = variance > 0.0 && variance < 1.0;
      frame.gap_share = went_on ? std::sqrt(variance) : ShareOfGap(record.stamp_s - before.stamp_s);
    }
  } else if (doubted) {
    frame.gap_share = kGuessedShare;
  }
  return frame;
}

}  // namespace depthgrid
