// Places the camera in the map when SLAM's poses begin a new epoch (docs/math.md, "Epochs").
#include <limits>

#include "mapper/core/level.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

// Uncertainty of the pose after a slip, before matching it again, as a multiple of kEpochSigma.
constexpr double kSlipSigmaShare = 0.3;

// Uncertainty of SLAM's own pose (multiple of kEpochSigma) where the map explains little of the
// scan: SLAM relocalises to a centimetre, while a match would be to what only looks alike, and
// overconfident.
constexpr double kWordSigmaShare = 0.1;
// Not so if a pose within kEpochSigma explains this share of what is usual (docs/tried.md, "Lost
// and found").
constexpr double kWhollyUsual = 0.9;

Eigen::Matrix3d AddedBy(double sigma_share) { return Squared(sigma_share * kEpochSigma); }

}  // namespace

bool IncrementalMapper::State::SameEpoch() const {
  return !filter_epoch || *filter_epoch == history.newest().epoch;
}

// SLAM's newest pose with the previous correction.
Pose2 IncrementalMapper::State::CarriedOn() const {
  return filter.Predict(BaseOf(*history.newest().slam_from_camera), history.newest().stamp_s)
      .map_from_base;
}

// Chooses between two guesses: the last motion continued, or the old correction still holds (SLAM
// relocalised in its own map).
IncrementalMapper::State::EpochStart IncrementalMapper::State::BegunAt(
    const std::shared_ptr<const Scan>& scan) {
  const Extrapolation went_on = Extrapolated(history, filter.map_from_slam());
  const EpochStart going_on{went_on.map_from_base, went_on.sigma_share, went_on.gap_share};
  EpochStart carried{CarriedOn(), 1.0};
  // What SLAM corrects is its own drift then, and the map drifted along.
  if (!has_matched) return carried;
  if (!scan) return went_on.near ? going_on : carried;
  const auto share = [&](const Pose2& guess, double sigma_share) {
    const MatchResult match =
        reference->Match(scan, {guess, filter.covariance() + AddedBy(sigma_share)});
    return match.found ? match.score : 0.0;
  };
  const double share_going_on = share(going_on.map_from_base, 0.0);
  const double share_carried = share(carried.map_from_base, 0.0);
  if (!relocation.IsUsual(share_carried) &&
      share(carried.map_from_base, 1.0) < kWhollyUsual * relocation.usual_share()) {
    carried.sigma_share = kWordSigmaShare;
  }
  const bool explained = relocation.IsUsual(share_going_on);
  // Beside a single wall both may be explained. From one frame to the next the motion continues,
  // whatever SLAM says; after a long gap the extrapolation is useless, and SLAM is trusted unless
  // the map clearly contradicts it.
  const bool goes_on = went_on.near ? share_going_on >= share_carried || (went_on.next && explained)
                                    : explained && !relocation.IsUsual(share_carried);
  return goes_on ? going_on : carried;
}

// The camera's pose according to SLAM during the search after a loss. SLAM relocalises in its own
// map, so the correction of the mapped frame nearest to the new SLAM pose is used, not the one just
// before the loss, when SLAM may have drifted from its map.
std::optional<Pose2> IncrementalMapper::State::SlamsWord() const {
  if (!relocation.doubts()) return std::nullopt;
  const Pose2 slam_from_newest = BaseOf(*history.newest().slam_from_camera);
  std::optional<Pose2> word;
  double least_apart = std::numeric_limits<double>::infinity();
  for (int i = 0; i < relocation.first_frame(); ++i) {
    const MappedFrame& frame = mapped.all()[static_cast<std::size_t>(i)];
    if (frame.of_prior_map()) continue;
    const Pose2 slam_from_base = BaseOf(*history.Find(frame.frame)->slam_from_camera);
    const double apart = Separation(slam_from_base, slam_from_newest);
    if (apart > least_apart) continue;
    least_apart = apart;
    word = frame.map_from_base * Between(slam_from_base, slam_from_newest);
  }
  return word;
}

void IncrementalMapper::State::BeginEpoch(const std::shared_ptr<const Scan>& scan) {
  const EpochStart start = BegunAt(scan);
  const std::optional<Pose2> word = SlamsWord();
  const int first = relocation.first_frame();
  const bool stays =
      !word || !scan ||
      relocation.IsUsual(reference->ShareSeenBefore(scan, start.map_from_base, first));
  if (stays) {
    Anchor(start);
    return;
  }
  // SLAM corrected itself after the loss: the frames mapped since move along.
  if (mapped.size() > first) MovePart(first, *word * Inverse(start.map_from_base));
  relocation.GuessMoved();
  Anchor({*word, 1.0});
}

// Sets the correction so that SLAM's newest pose is at `start`, with `sigma_share` times
// kEpochSigma added uncertainty.
void IncrementalMapper::State::Anchor(const EpochStart& start) {
  const FrameRecord& record = history.newest();
  const Eigen::Matrix3d added = AddedBy(start.sigma_share);
  filter.Restart(BaseOf(*record.slam_from_camera), record.stamp_s, start.map_from_base,
                 filter.covariance() + added);
  errors.BeginEpoch(start.map_from_base, added, filter.step().new_bias);
  filter_epoch = record.epoch;
  gap_variance += start.gap_share * start.gap_share;
}

// Whether that little of a scan is explained tells that SLAM's pose is wrong.
bool IncrementalMapper::State::TellsSlips() const {
  return options.loops.relocation.use && options.method == MapperMethod::kSurfel &&
         CanTellSlips(options.fusion) && !relocation.doubts();
}

bool IncrementalMapper::State::SearchesSlips() const { return TellsSlips() && !fixed_map; }

std::optional<Pose2> IncrementalMapper::State::TurnedTo(const std::shared_ptr<const Scan>& scan,
                                                        const Prediction& prediction,
                                                        FrameReport& report) {
  const StageTimer timer(clocks, report.times.match_us);
  const FrameRecord& last = *history.Find(slips.last_frame());
  const Pose2 map_from_last = filter.map_from_slam() * BaseOf(*last.slam_from_camera);
  return slips.Find(scan, prediction, {map_from_last, history.LongestUsualWayM(last)},
                    mapped.size(), *reference);
}

// Searches for a slip and, if there was one, begins an epoch at the corrected heading; else SLAM's
// pose may be late, or the camera may have been carried elsewhere.
Prediction IncrementalMapper::State::AfterSlip(const FrameScans& scans,
                                               const Prediction& prediction, FrameReport& report) {
  const std::shared_ptr<const Scan>& scan = scans.matched;
  if (!reference || !scan || mapped.empty() || match_oracle) return prediction;
  Prediction mended = prediction;
  if (SearchesSlips() && slips.IsSuspected(history.newest(), ShareExplained(report), relocation)) {
    if (const std::optional<Pose2> turned = TurnedTo(scan, prediction, report)) {
      history.BeginEpoch();
      Anchor({*turned, kSlipSigmaShare});
      report.slipped = true;
      mended = filter.Predict(BaseOf(*history.newest().slam_from_camera), report.stamp_s);
    }
    Match(scan, mended, report);
  }
  if (!report.slipped) {
    MatchWhereMotionWentOn(scan, mended, report);
    mended = AfterCarrying(scans, mended, report);
  }
  slips.Placed(history.newest(), scan, report.match);
  return mended;
}

}  // namespace depthgrid
