// Matches a scan where the motion before it leads (docs/math.md, "Poses that are read late").
#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

// Of a laser's scans nearly all is explained; of depth images half, with variations.
constexpr double kWhollySeen = 0.8;
// A scan of which less than this share of the usual is explained where SLAM puts it may lie
// elsewhere.
constexpr double kFellShort = 0.8;
// So much more of it must be explained there.
constexpr double kLeastGain = 0.1;
// Nearer to SLAM's pose the match from there is the same, or has slid along a wall.
constexpr double kLeastOffM = 0.05;
constexpr double kLeastOffRad = RadFromDeg(2.0);
// Beyond this a motion may have ended (kNearS).
constexpr double kLongestStepS = 0.7;

}  // namespace

// The newest frame's pose if the motion between the two poses before it, as they lie in the map,
// went on: SLAM's poses have no part in it.
std::optional<Pose2> IncrementalMapper::State::WhereMotionWentOn() const {
  const std::vector<FrameRecord>& records = history.records();
  const std::vector<MappedFrame>& frames = mapped.all();
  if (records.size() < 3 || frames.size() < 2) return std::nullopt;
  const MappedFrame& before = frames[frames.size() - 2];
  const MappedFrame& last = frames.back();
  if (records[records.size() - 3].index != before.frame) return std::nullopt;
  if (records[records.size() - 2].index != last.frame || !last.slam_motion) return std::nullopt;
  const double step_s = history.newest().stamp_s - last.stamp_s;
  const double step_before_s = last.stamp_s - before.stamp_s;
  if (step_s <= 0.0 || step_s > kLongestStepS || step_before_s <= 0.0) return std::nullopt;
  if (step_before_s > kLongestStepS) return std::nullopt;
  const Pose2 motion = Between(before.map_from_base, last.map_from_base);
  return last.map_from_base * Pose2::FromVector(step_s / step_before_s * motion.vector());
}

// Odometry that is read long before or after the scan was taken is decimetres off in one frame and
// right again in the next. A match from there may end nearby, where little of the scan is
// explained.
void IncrementalMapper::State::MatchWhereMotionWentOn(const std::shared_ptr<const Scan>& scan,
                                                      const Prediction& prediction,
                                                      FrameReport& report) {
  const double share = ShareExplained(report);
  const double usual = relocation.usual_share();
  if (!SearchesSlips() || usual < kWhollySeen || share >= kFellShort * usual) return;
  const std::optional<Pose2> there = WhereMotionWentOn();
  if (!there) return;
  const Pose2 off = Between(prediction.map_from_base, *there);
  if (off.translation().norm() < kLeastOffM && std::abs(off.yaw_rad) < kLeastOffRad) return;
  MatchResult found;
  {
    const StageTimer timer(clocks, report.times.match_us);
    found = reference->Match(
        scan, {*there, prediction.covariance + Squared(kEpochSigma), prediction.motion_covariance});
  }
  if (found.found && found.score >= share + kLeastGain) {
    report.match = found;
    report.match.information = InformationFor(prediction, found, options.fusion.tilt_rad);
  } else {
    Match(scan, prediction, report);  // the reference tells the parts of the last match
  }
}

}  // namespace depthgrid
