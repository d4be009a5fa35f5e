// A sequence mapped from front to back, whatever it came from, and all that is worth keeping of it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/saturation_check.h"
#include "mapper/core/frame.h"
#include "mapper/core/frame_report.h"
#include "mapper/core/slam_output.h"
#include "mapper/core/trajectory.h"
#include "mapper/incremental_mapper.h"

namespace depthgrid {

// Told after each frame; may throw to stop.
using Progress = std::function<void(int done, int total)>;

// A frame kept whole for the report.
struct SampleFrame {
  int frame = 0;
  std::shared_ptr<const DepthImage> depth;
};

struct MappingRun {
  std::vector<FrameReport> reports;  // one an input frame
  MapperResult result;
  std::vector<LoopClosure> loops;  // SLAM's events as they came in
  std::optional<PinholeCamera> camera;
  // Of sources without a camera, whose frames are a laser's: trajectories are the base's.
  Pose2 base_from_laser;
  std::vector<SampleFrame> samples;
  std::vector<std::string> warnings;
  double wall_s = 0.0;
  double cpu_s = 0.0;  // of the mapper's thread, sources excluded where they have their own
};

// Maps a sequence whose frames are handed over one by one.
class FrameRecorder {
 public:
  // `oracle` is asked by fusion.mode `oracle` only, `match_oracle` for every match when it is
  // given.
  FrameRecorder(const MapperOptions& options, const std::optional<PinholeCamera>& camera,
                int frame_count, const GainOracle& oracle = {},
                const MatchOracle& match_oracle = {});

  // Before the first frame: the run goes on in a finished map.
  void StartFrom(const PriorMap& prior) { mapper_.StartFrom(prior); }
  void Add(const Frame& frame);
  // `final_poses`: SLAM's own final trajectory, empty if there is none. Once, at the end.
  MappingRun Finish(const Trajectory& final_poses);

 private:
  std::vector<std::string> Warnings() const;

  std::chrono::steady_clock::time_point start_;
  int frame_count_;
  double max_range_m_;
  SaturationCheck saturation_;
  IncrementalMapper mapper_;
  MappingRun run_;
};

// CPU time a frame, of those with a pose: the others are not mapped.
std::vector<double> TimesOfMappedFrames(const MappingRun& run);

// What the mapper did about poses that were wrong, a line each: slips and losses of SLAM.
std::vector<std::string> MendedPoses(const std::vector<FrameReport>& reports);

// The first frame (Frame::index) after a loss of SLAM whose place to what was mapped before is a
// guess to the end: nothing seen since confirmed it, and no loop joins the two.
std::optional<int> GuessedFrom(const MappingRun& run);

// The whole of a source, front to back.
// `final_poses`: SLAM's own final trajectory, empty if there is none. `oracle` is asked by
// fusion.mode `oracle` only, `match_oracle` for every match when it is given. With `prior` the run
// goes on in a finished map.
MappingRun MapFrames(FrameSource& source, const MapperOptions& options,
                     const Trajectory& final_poses, const Progress& progress,
                     const GainOracle& oracle = {}, const MatchOracle& match_oracle = {},
                     const std::optional<PriorMap>& prior = {});

// Poses as the run's trajectory files have them; frames without a pose are absent. Those of a
// source without a camera are planar (x, y, yaw about z, at height 0), as a laser log's own
// odometry is, and of what that is of: of the base.
Trajectory SlamTrajectory(const MappingRun& run);    // the input, live
Trajectory OnlineTrajectory(const MappingRun& run);  // estimates as known at the time
Trajectory FinalTrajectory(const MappingRun& run);   // estimates after all corrections

}  // namespace depthgrid
