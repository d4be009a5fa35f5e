#include "eval/doubts/stretches.h"

#include <optional>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/core/slam_epochs.h"

namespace depthgrid {
namespace {

int EpochOf(const FrameReport& report, SlamEpochs& epochs) {
  Frame frame;
  frame.stamp_s = report.stamp_s;
  frame.slam_epoch = report.slam_epoch;
  frame.slam_from_camera = report.slam_from_camera;
  return epochs.Of(frame);
}

}  // namespace

std::vector<Stretch> StretchesOf(const MappingRun& run,
                                 const std::function<bool(const Stretch&)>& done) {
  std::vector<Stretch> stretches;
  std::optional<Stretch> stretch;
  Pose2 slam_begin, map_begin, slam_last, map_last;
  SlamEpochs epochs;
  int last_epoch = 0;
  bool last_guessed = false;
  for (std::size_t i = 0; i < run.reports.size(); ++i) {
    const auto& slam_pose = run.reports[i].slam_from_camera;
    const auto& map_pose = run.result.map_from_camera[i];
    const int epoch = EpochOf(run.reports[i], epochs);
    const bool guessed = run.reports[i].guessed;
    const bool begins_part = epoch != last_epoch || (guessed && !last_guessed);
    if (!slam_pose || !map_pose || begins_part) stretch.reset();
    last_epoch = epoch;
    last_guessed = guessed;
    if (!slam_pose || !map_pose) continue;
    const Pose2 slam = BaseOf(*slam_pose);
    const Pose2 map = BaseOf(*map_pose);
    if (stretch) {
      stretch->slam = Between(slam_begin, slam);
      stretch->map = Between(map_begin, map);
      stretch->slam_turn_rad += WrapAngle(slam.yaw_rad - slam_last.yaw_rad);
      stretch->map_turn_rad += WrapAngle(map.yaw_rad - map_last.yaw_rad);
    }
    slam_last = slam;
    map_last = map;
    if (stretch && !done(*stretch)) continue;
    if (stretch) stretches.push_back(*stretch);
    stretch.emplace();
    slam_begin = slam;
    map_begin = map;
  }
  return stretches;
}

std::vector<Stretch> WaysAndTurnsOf(const MappingRun& run) {
  return StretchesOf(run, [](const Stretch& stretch) {
    return stretch.longer_m() >= kStretchM || stretch.larger_turn_rad() >= kStretchRad;
  });
}

}  // namespace depthgrid
