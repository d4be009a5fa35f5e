#include "mapper/slip_search.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

// A slip is sudden (docs/tried.md, "Slips"): longest time since the last, well explained scan, and
// share of its explained share below which a slip is suspected.
constexpr double kLongestSlipS = 0.5;
constexpr double kSlippedShare = 0.5;
// Least usual share for slips to be detectable: of a laser's scans nearly all is explained, of
// depth images half, with variations.
constexpr double kWhollyExplained = 0.8;
// What a heading must explain relative to the last scan, as share and as number of surfels: the end
// of a wall may remove a quarter of them.
constexpr double kMendedShare = 0.8;
constexpr double kMendedNumber = 0.5;
// Few surfels always fit at some heading. False slips had at most 12 explained surfels, true ones
// at least 23, with a laser of 180 beams (docs/tried.md, "Slips").
constexpr int kFewestSurfels = 15;
// Least accuracy of the heading: the step of the search.
constexpr double kKnownRad = RadFromDeg(1.0);
// A slip must exceed SLAM's learnt noise by four sigmas, each at least kLeastSigma.
constexpr double kLeastChi2 = 16.0;
const Eigen::Vector3d kLeastSigma(1e-3, 1e-3, 1e-3);
// A person filling the view was drawn recently and matches anywhere, so surfaces older than this
// must support the heading as well.
constexpr int kDrawnLatelyFrames = 30;
// While the camera turns, it sees fewer old surfaces in each frame. So this share suffices for a
// slip in place (within kInPlaceM), if it exceeds that at the prediction: a passer-by would shift
// the pose by some centimetres (docs/tried.md, "Slips").
constexpr double kTurnedShare = 0.5;
constexpr double kInPlaceM = 0.015;
// Where fewer surfels of the last scan have stood for long, they bear out no pose elsewhere that is
// hardly turned: a wall that has just come into view is as young as a passer-by. Such false slips
// had up to 2.2 surfels and 2.1 degrees, true ones 3.9 surfels or 8 degrees (docs/tried.md,
// "Slips").
constexpr double kFewestLasting = 3.0;
constexpr double kTurnedRad = RadFromDeg(3.0);
// The estimate of the last pose and that of this one may differ by so much more than the camera
// went. Chosen; of the false slips in docs/tried.md, "Lost and found", one of 5 cm passes.
constexpr double kEstimateErrorM = 0.02;
// Smaller slips are corrected by the match itself.
constexpr double kLeastSlipM = 0.05;
constexpr double kLeastSlipRad = RadFromDeg(2.0);
// In logs without slips, up to six were found with fixed gains of 0, 0.02, 0.05 and 0.1 along one
// axis or all, none with 0.2 and 0.5 (two rooms, simulated).
constexpr double kLeastFixedGain = 0.2;
// Spacing of the headings tried, and sigma of a match around each: m, m, rad.
constexpr double kHeadingStepDeg = 1.0;
const Eigen::Vector3d kHeadingSigma(0.03, 0.03, 0.01);

bool IsSlip(const Pose2& motion, const Eigen::Matrix3d& covariance) {
  if (std::abs(motion.yaw_rad) < kLeastSlipRad && motion.translation().norm() < kLeastSlipM) {
    return false;
  }
  const Eigen::Vector3d off = motion.vector();
  const Eigen::Matrix3d usual = covariance + Squared(kLeastSigma);
  return off.dot(usual.ldlt().solve(off)) >= kLeastChi2;
}

// Whether the match, with the prediction's position, determines the heading to kKnownRad.
bool KnowsHeading(const MatchResult& match, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d known = match.information;
  known.topLeftCorner<2, 2>() += covariance.topLeftCorner<2, 2>().inverse();
  return std::sqrt(known.inverse()(2, 2)) <= kKnownRad;
}

// The scan without hits at bearings where the other scan has none: what enters or leaves the view
// tells nothing about the motion.
std::shared_ptr<const Scan> SeenByBoth(const Scan& scan, const Scan& other,
                                       const Pose2& other_from_scan) {
  constexpr int kBins = 180;
  const auto bin = [](double bearing_rad) {
    const double turns = WrapAngle(bearing_rad) / (2.0 * kPi) + 0.5;
    return static_cast<std::size_t>(std::clamp(static_cast<int>(turns * kBins), 0, kBins - 1));
  };
  std::array<bool, kBins> has_hit{};
  for (const Beam& beam : other.beams) {
    if (beam.hit) has_hit[bin(beam.bearing_rad)] = true;
  }
  auto both = std::make_shared<Scan>(scan);
  for (Beam& beam : both->beams) {
    if (!beam.hit) continue;
    const Eigen::Vector2d end = other_from_scan * EndPoint(beam);
    beam.hit = has_hit[bin(std::atan2(end.y(), end.x()))];
  }
  return both;
}

}  // namespace

bool CanTellSlips(const FusionOptions& fusion) {
  return fusion.mode != FusionMode::kFixed ||
         *std::min_element(fusion.gain.begin(), fusion.gain.end()) >= kLeastFixedGain;
}

bool SlipSearch::FellSuddenly(const FrameRecord& frame, double share,
                              const Relocation& usually) const {
  return last_scan_ && last_epoch_ == frame.epoch &&
         frame.stamp_s - last_stamp_s_ < kLongestSlipS && usually.IsUsual(last_share_) &&
         share < kSlippedShare * last_share_;
}

bool SlipSearch::IsSuspected(const FrameRecord& frame, double share,
                             const Relocation& usually) const {
  return slip_deg_ > 0.0 && usually.usual_share() >= kWhollyExplained &&
         last_explained_ >= kFewestSurfels && FellSuddenly(frame, share, usually);
}

std::optional<MatchResult> SlipSearch::BestHeading(const std::shared_ptr<const Scan>& scan,
                                                   const Prediction& prediction, const Last& last,
                                                   ReferenceMap& reference) const {
  const Eigen::Matrix3d covariance = prediction.covariance + Squared(kHeadingSigma);
  const int most = static_cast<int>(slip_deg_ / kHeadingStepDeg);
  const int fewest = std::max(kFewestSurfels, static_cast<int>(kMendedNumber * last_explained_));
  std::optional<MatchResult> best;
  double least_share = kMendedShare * last_share_;
  for (int i = -most; i <= most; ++i) {
    const Pose2 turned =
        prediction.map_from_base * Pose2{0.0, 0.0, i * RadFromDeg(kHeadingStepDeg)};
    const MatchResult match = reference.Match(scan, {turned, covariance});
    if (!match.found || match.score <= least_share || match.explained < fewest) continue;
    if (!KnowsHeading(match, covariance)) continue;
    const Pose2 slip = Between(prediction.map_from_base, match.map_from_base);
    if (!IsSlip(slip, prediction.covariance)) continue;
    // In a slip SLAM moves as the camera does not. What the camera cannot have reached looks alike.
    const double way_m = Between(last.map_from_base, match.map_from_base).translation().norm();
    if (way_m > last.longest_way_m + kEstimateErrorM) continue;
    least_share = match.score;
    best = match;
  }
  return best;
}

std::optional<Pose2> SlipSearch::Find(const std::shared_ptr<const Scan>& scan,
                                      const Prediction& prediction, const Last& at_last,
                                      int mapped_frames, ReferenceMap& reference) const {
  const std::optional<MatchResult> best = BestHeading(scan, prediction, at_last, reference);
  if (!best) return {};
  const Pose2 found = best->map_from_base;
  const int before = std::max(0, mapped_frames - kDrawnLatelyFrames);
  const Pose2 last_from_found = Between(at_last.map_from_base, found);
  const auto last_lasting = SeenByBoth(*last_scan_, *scan, Inverse(last_from_found));
  const auto lasting = SeenByBoth(*scan, *last_scan_, last_from_found);
  const double last = reference.ShareSeenBefore(last_lasting, at_last.map_from_base, before);
  const double there = reference.ShareSeenBefore(lasting, found, before);
  const Pose2 slip = Between(prediction.map_from_base, found);
  const bool in_place = slip.translation().norm() < kInPlaceM;
  const bool is_turn = in_place || std::abs(slip.yaw_rad) >= kTurnedRad;
  if (!is_turn && last * best->explained < kFewestLasting) return {};
  // Standard deviation of the share with so few surfels.
  const double scatter = std::sqrt(last * (1.0 - last) / best->explained);
  if (there >= kMendedShare * last - scatter) return found;
  const double here = reference.ShareSeenBefore(lasting, prediction.map_from_base, before);
  const bool wants_turn = in_place && there > here && there >= kTurnedShare * last;
  if (wants_turn) return found;
  return {};
}

void SlipSearch::Placed(const FrameRecord& frame, const std::shared_ptr<const Scan>& scan,
                        const MatchResult& match) {
  last_frame_ = frame.index;
  last_stamp_s_ = frame.stamp_s;
  last_epoch_ = frame.epoch;
  last_share_ = match.found ? match.score : 0.0;
  last_explained_ = match.found ? match.explained : 0;
  last_scan_ = scan;
}

}  // namespace depthgrid
