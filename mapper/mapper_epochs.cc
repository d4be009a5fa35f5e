// Where the map goes on when SLAM's poses begin a new epoch (docs/math.md, "Epochs").
#include <limits>

#include "mapper/core/level.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

// Of kEpochSigma: how well the place after a slip is known before it is matched once more.
constexpr double kSlipSigmaShare = 0.3;

// SLAM comes back into its own map to a centimetre. Where the map explains little of what is seen
// then, a match is made against what only looks alike and is surer than it is right.
constexpr double kWordSigmaShare = 0.1;
// Unless a pose within kEpochSigma of it explains the scan as well as scans usually are
// (docs/tried.md, "Lost and found").
constexpr double kWhollyUsual = 0.9;

Eigen::Matrix3d AddedBy(double sigma_share) { return Squared(sigma_share * kEpochSigma); }

double ShareExplained(const FrameReport& report) {
  return report.match.found ? report.match.score : 0.0;
}

}  // namespace

bool IncrementalMapper::State::SameEpoch() const {
  return !filter_epoch || *filter_epoch == history.newest().epoch;
}

// SLAM's pose with the correction that stood before it.
Pose2 IncrementalMapper::State::CarriedOn() const {
  return filter.Predict(BaseOf(*history.newest().slam_from_camera), history.newest().stamp_s)
      .map_from_base;
}

// Two guesses: the camera went on as it did, or SLAM's new pose means the same place of the map as
// its old poses did (a relocalisation).
IncrementalMapper::State::EpochStart IncrementalMapper::State::BegunAt(
    const std::shared_ptr<const Scan>& scan) {
  const Extrapolation went_on = Extrapolated(history, filter.map_from_slam());
  const EpochStart going_on{went_on.map_from_base, went_on.sigma_share};
  EpochStart carried{CarriedOn(), 1.0};
  if (!scan || mapped.empty()) return went_on.near ? going_on : carried;
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
  // Along a lone wall both may be. From one frame to the next the camera went on, whatever SLAM
  // says; after a longer gap the last motion says nothing, and SLAM is believed unless it is
  // plainly wrong.
  const bool goes_on = went_on.near ? share_going_on >= share_carried || (went_on.next && explained)
                                    : explained && !relocation.IsUsual(share_carried);
  return goes_on ? going_on : carried;
}

// Where SLAM says that the camera is, after a loss that is not understood yet. SLAM finds its way
// back into its own map, so what stood there in the map when it was there before is what counts,
// not the correction just before the loss, when SLAM may have drifted away from its map.
std::optional<Pose2> IncrementalMapper::State::SlamsWord() const {
  if (!relocation.active()) return std::nullopt;
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
  // SLAM, back from a loss, has corrected where it came back to. What was seen since moves along.
  if (mapped.size() > first) MovePart(first, *word * Inverse(start.map_from_base));
  relocation.GuessMoved();
  Anchor({*word, 1.0});
}

// The correction is chosen so that SLAM's newest pose lies there; `sigma_share` of kEpochSigma is
// how well it is known to.
void IncrementalMapper::State::Anchor(const EpochStart& start) {
  const FrameRecord& record = history.newest();
  const Eigen::Matrix3d added = AddedBy(start.sigma_share);
  filter.Restart(BaseOf(*record.slam_from_camera), record.stamp_s, start.map_from_base,
                 filter.covariance() + added);
  errors.BeginEpoch(start.map_from_base, added, filter.step().new_bias);
  filter_epoch = record.epoch;
}

bool IncrementalMapper::State::SearchesSlips() const {
  return options.loops.relocation.use && options.method == MapperMethod::kSurfel &&
         CanTellSlips(options.fusion) && !relocation.active();
}

std::optional<Pose2> IncrementalMapper::State::TurnedTo(const std::shared_ptr<const Scan>& scan,
                                                        const Prediction& prediction,
                                                        FrameReport& report) {
  const StageTimer timer(clocks, report.times.match_us);
  const FrameRecord& last = *history.Find(slips.last_frame());
  const Pose2 map_from_last = filter.map_from_slam() * BaseOf(*last.slam_from_camera);
  return slips.Find(scan, prediction, map_from_last, mapped.size(), *reference);
}

// Where wheels slipped, or SLAM turned by less than shows in its poses, an epoch begins.
Prediction IncrementalMapper::State::AfterSlip(const std::shared_ptr<const Scan>& scan,
                                               const Prediction& prediction, FrameReport& report) {
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
  slips.Placed(history.newest(), scan, report.match);
  return mended;
}

bool IncrementalMapper::State::SearchesSlides() const {
  return options.loops.slide.use && options.method == MapperMethod::kSurfel && reference &&
         !fixed_map && !match_oracle && !relocation.active();
}

// Where it seems to have been matched beside walls that it slid along.
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

}  // namespace depthgrid
