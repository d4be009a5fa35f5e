#include "mapper/slip_search.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

// A slip is sudden (docs/tried.md, "Slips"): the last scan was so short ago, it was explained as
// usual, and this one by less than this share of it.
constexpr double kLongestSlipS = 0.5;
constexpr double kSlippedShare = 0.5;
// Of a laser's scans nearly all is explained. Of depth images it is half, and goes up and down.
constexpr double kWhollyExplained = 0.8;
// What a heading must explain of what the last scan's did.
constexpr double kMendedShare = 0.8;
// Somebody who fills the view was drawn lately and is found where they are now, so what has stood
// for longer must want that heading as well.
constexpr int kDrawnLatelyFrames = 30;
// While the camera turns, less of what it sees has stood for so long from frame to frame. So half
// is enough for a slip that turned in place, if that is more than at the prediction: who walks by
// is found some centimetres aside (docs/tried.md, "Slips").
constexpr double kTurnedShare = 0.5;
constexpr double kInPlaceM = 0.015;
// Less, a match finds by itself.
constexpr double kLeastSlipM = 0.05;
constexpr double kLeastSlipRad = RadFromDeg(2.0);
// Headings tried, and how far a match may go from one.
constexpr double kHeadingStepDeg = 1.0;
const Eigen::Vector3d kHeadingSigma(0.03, 0.03, 0.01);

bool IsSlip(const Pose2& motion) {
  return std::abs(motion.yaw_rad) >= kLeastSlipRad || motion.translation().norm() >= kLeastSlipM;
}

}  // namespace

bool SlipSearch::IsSuspected(const FrameRecord& frame, double share,
                             const Relocation& usually) const {
  return slip_deg_ > 0.0 && last_scan_ && last_epoch_ == frame.epoch &&
         frame.stamp_s - last_stamp_s_ < kLongestSlipS &&
         usually.usual_share() >= kWhollyExplained && usually.IsUsual(last_share_) &&
         share < kSlippedShare * last_share_;
}

std::optional<Pose2> SlipSearch::Find(const std::shared_ptr<const Scan>& scan,
                                      const Prediction& prediction, const Pose2& map_from_last,
                                      int mapped_frames, ReferenceMap& reference) const {
  const int before = std::max(0, mapped_frames - kDrawnLatelyFrames);
  const double lasting_share = reference.ShareSeenBefore(last_scan_, map_from_last, before);
  const Eigen::Matrix3d covariance = prediction.covariance + Squared(kHeadingSigma);
  const int most = static_cast<int>(slip_deg_ / kHeadingStepDeg);
  std::optional<Pose2> found;
  double best = kMendedShare * last_share_;
  for (int i = -most; i <= most; ++i) {
    const Pose2 turned =
        prediction.map_from_base * Pose2{0.0, 0.0, i * RadFromDeg(kHeadingStepDeg)};
    const MatchResult match = reference.Match(scan, {turned, covariance});
    if (!match.found || match.score <= best) continue;
    if (!IsSlip(Between(prediction.map_from_base, match.map_from_base))) continue;
    best = match.score;
    found = match.map_from_base;
  }
  if (!found) return {};
  const double there = reference.ShareSeenBefore(scan, *found, before);
  if (there >= kMendedShare * lasting_share) return found;
  const Pose2 slip = Between(prediction.map_from_base, *found);
  const double here = reference.ShareSeenBefore(scan, prediction.map_from_base, before);
  const bool in_place = slip.translation().norm() < kInPlaceM;
  const bool wants_turn = in_place && there > here && there >= kTurnedShare * lasting_share;
  return wants_turn ? found : std::nullopt;
}

void SlipSearch::Placed(const FrameRecord& frame, const std::shared_ptr<const Scan>& scan,
                        double share) {
  last_frame_ = frame.index;
  last_stamp_s_ = frame.stamp_s;
  last_epoch_ = frame.epoch;
  last_share_ = share;
  last_scan_ = scan;
}

}  // namespace depthgrid
