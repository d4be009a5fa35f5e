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

// Where the map has a frame: what was mapped moves with the map, which a localised camera does not.
// `back`: how many frames before the newest it was mapped.
std::optional<Pose2> IncrementalMapper::State::InMap(const FrameRecord& record,
                                                     std::size_t back) const {
  if (fixed_map) {
    if (relocation.unsettled() || !record.slam_from_camera) return std::nullopt;
    return record.map_from_slam * BaseOf(*record.slam_from_camera);
  }
  const std::vector<MappedFrame>& frames = mapped.all();
  if (frames.size() < back || frames[frames.size() - back].frame != record.index) {
    return std::nullopt;
  }
  return frames[frames.size() - back].map_from_base;
}

// The newest frame's pose if the motion between the two poses before it, as they lie in the map,
// went on: SLAM's poses have no part in it.
std::optional<Pose2> IncrementalMapper::State::WhereMotionWentOn() const {
  const std::vector<FrameRecord>& records = history.records();
  if (records.size() < 3) return std::nullopt;
  const FrameRecord& before = records[records.size() - 3];
  const FrameRecord& last = records[records.size() - 2];
  const std::optional<Pose2> map_from_before = InMap(before, 2);
  const std::optional<Pose2> map_from_last = InMap(last, 1);
  if (!map_from_before || !map_from_last || before.epoch != last.epoch) return std::nullopt;
  const double step_s = history.newest().stamp_s - last.stamp_s;
  const double step_before_s = last.stamp_s - before.stamp_s;
  if (step_s <= 0.0 || step_s > kLongestStepS || step_before_s <= 0.0) return std::nullopt;
  if (step_before_s > kLongestStepS) return std::nullopt;
  const Pose2 motion = Between(*map_from_before, *map_from_last);
  return *map_from_last * Pose2::FromVector(step_s / step_before_s * motion.vector());
}

// Odometry that is read long before or after the scan was taken is decimetres off in one frame and
// right again in the next. A match from there may end nearby, where little of the scan is
// explained.
void IncrementalMapper::State::MatchWhereMotionWentOn(const std::shared_ptr<const Scan>& scan,
                                                      const Prediction& prediction,
                                                      FrameReport& report) {
  const double share = ShareExplained(report);
  const double usual = relocation.usual_share();
  if (!TellsSlips() || usual < kWhollySeen || share >= kFellShort * usual) return;
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
