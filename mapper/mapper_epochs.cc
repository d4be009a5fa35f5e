// Where the map goes on when SLAM's poses begin a new epoch (docs/math.md, "Epochs").
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/core/level.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

// Where wheels slip (docs/tried.md, "Slips"). It is sudden: the last pose was so short ago, the
// scan then was explained as usual, and this one by less than this share of it.
constexpr double kLongestSlipS = 0.5;
constexpr double kSlippedShare = 0.5;
// Of a laser's scans nearly all is explained. Of depth images it is half, and goes up and down.
constexpr double kWhollyExplained = 0.8;
// What a heading must explain of what the last scan's did.
constexpr double kMendedShare = 0.8;
constexpr int kDrawnLatelyFrames = 30;
// Less, a match finds by itself.
constexpr double kLeastSlipM = 0.05;
constexpr double kLeastSlipRad = RadFromDeg(2.0);
// Headings tried, and how far a match may go from one.
constexpr double kHeadingStepRad = RadFromDeg(1.0);
const Eigen::Vector3d kHeadingSigma(0.03, 0.03, 0.01);
// Of kEpochSigma: how well the place of the best one is known before it is matched once more.
constexpr double kSlipSigmaShare = 0.3;

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
  const EpochStart carried{CarriedOn(), 1.0};
  if (!scan || mapped.empty()) return went_on.near ? going_on : carried;
  const auto share = [&](const EpochStart& guess) {
    const MatchResult match = reference->Match(scan, {guess.map_from_base, filter.covariance()});
    return match.found ? match.score : 0.0;
  };
  const double share_going_on = share(going_on), share_carried = share(carried);
  // After a longer gap the last motion says nothing, and SLAM is believed unless it is plainly
  // wrong.
  const bool goes_on =
      went_on.near ? share_going_on >= share_carried
                   : relocation.IsUsual(share_going_on) && !relocation.IsUsual(share_carried);
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
  filter.Commit(BaseOf(*record.slam_from_camera), record.stamp_s, start.map_from_base,
                filter.covariance() + Squared(start.sigma_share * kEpochSigma));
  errors.Break();
  filter_epoch = record.epoch;
}

// Whether the map explained the last scan and all at once explains hardly any of this one.
bool IncrementalMapper::State::Slipped(const FrameReport& report) const {
  const FrameRecord* last = history.PosedBefore(history.newest());
  return options.loops.relocation.use && options.loops.relocation.slip_deg > 0.0 &&
         options.method == MapperMethod::kSurfel && !relocation.active() && last != nullptr &&
         last->epoch == history.newest().epoch && report.stamp_s - last->stamp_s < kLongestSlipS &&
         relocation.usual_share() >= kWhollyExplained && relocation.IsUsual(last_share) &&
         report.match.score < kSlippedShare * last_share;
}

// The pose at another heading at which the map explains the scan about as well as the last one.
// Somebody who fills the view was drawn lately and is found where they are now, so what has stood
// for longer must want that heading as well.
std::optional<Pose2> IncrementalMapper::State::TurnedTo(const std::shared_ptr<const Scan>& scan,
                                                        const Prediction& prediction,
                                                        FrameReport& report) {
  const StageTimer timer(clocks, report.times.match_us);
  const int before = std::max(0, mapped.size() - kDrawnLatelyFrames);
  const Pose2 last =
      filter.map_from_slam() * BaseOf(*history.PosedBefore(history.newest())->slam_from_camera);
  const double lasting_share = reference->ShareSeenBefore(last_scan, last, before);
  const Eigen::Matrix3d covariance = prediction.covariance + Squared(kHeadingSigma);
  const int most =
      static_cast<int>(RadFromDeg(options.loops.relocation.slip_deg) / kHeadingStepRad);
  std::optional<Pose2> found;
  double best = kMendedShare * last_share;
  for (int i = -most; i <= most; ++i) {
    const Pose2 turned = prediction.map_from_base * Pose2{0.0, 0.0, i * kHeadingStepRad};
    const MatchResult match = reference->Match(scan, {turned, covariance});
    if (!match.found || match.score <= best) continue;
    const Pose2 slip = Between(prediction.map_from_base, match.map_from_base);
    if (std::abs(slip.yaw_rad) < kLeastSlipRad && slip.translation().norm() < kLeastSlipM) continue;
    best = match.score;
    found = match.map_from_base;
  }
  if (!found || reference->ShareSeenBefore(scan, *found, before) < kMendedShare * lasting_share) {
    return {};
  }
  return found;
}

// Where wheels slipped, or SLAM turned by less than shows in its poses, an epoch begins.
Prediction IncrementalMapper::State::AfterSlip(const std::shared_ptr<const Scan>& scan,
                                               const Prediction& prediction, FrameReport& report) {
  if (!reference || !scan || mapped.empty() || match_oracle) return prediction;
  Prediction mended = prediction;
  if (Slipped(report)) {
    if (const std::optional<Pose2> turned = TurnedTo(scan, prediction, report)) {
      history.BeginEpoch();
      Anchor({*turned, kSlipSigmaShare});
      mended = filter.Predict(BaseOf(*history.newest().slam_from_camera), report.stamp_s);
    }
    Match(scan, mended, report);
  }
  last_share = report.match.found ? report.match.score : 0.0;
  last_scan = scan;
  return mended;
}

}  // namespace depthgrid
