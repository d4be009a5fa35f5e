// Maps a whole sequence from any source and collects the results.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/saturation_check.h"
#include "eval/run/unmatched_views.h"
#include "mapper/core/frame.h"
#include "mapper/core/frame_report.h"
#include "mapper/core/slam_output.h"
#include "mapper/core/trajectory.h"
#include "mapper/incremental_mapper.h"

namespace depthgrid {

// Called after each frame; may throw to stop.
using Progress = std::function<void(int done, int total)>;

// A frame kept whole for the report.
struct SampleFrame {
  int frame = 0;
  std::shared_ptr<const DepthImage> depth;
};

struct MappingRun {
  std::vector<FrameReport> reports;  // one per input frame
  MapperResult result;
  std::vector<LoopClosure> loops;  // as reported by SLAM, in order
  std::optional<PinholeCamera> camera;
  // For sources without a camera, whose frames are a laser's; their trajectories are the base's.
  Pose2 base_from_laser;
  std::vector<SampleFrame> samples;
  UnmatchedViews unmatched;
  std::vector<std::string> warnings;
  double wall_s = 0.0;
  double cpu_s = 0.0;  // of the mapper's thread; includes the source unless it has its own threads
};

// Maps a sequence whose frames are added one by one.
class FrameRecorder {
 public:
  // `oracle` is used by fusion.mode `oracle` only, `match_oracle`, if given, for every match.
  FrameRecorder(const MapperOptions& options, const std::optional<PinholeCamera>& camera,
                int frame_count, const GainOracle& oracle = {},
                const MatchOracle& match_oracle = {});

  // Continues in a finished map. Call it before the first frame.
  void StartFrom(const PriorMap& prior) { mapper_.StartFrom(prior); }
  void Add(const Frame& frame);
  // `final_poses`: SLAM's own final trajectory, empty if there is none. Call it once, at the end.
  MappingRun Finish(const Trajectory& final_poses);

 private:
  std::vector<std::string> Warnings() const;

  std::chrono::steady_clock::time_point start_;
  int frame_count_;
  ScanOptions scan_;
  SaturationCheck saturation_;
  IncrementalMapper mapper_;
  MappingRun run_;
};

// CPU time of each frame with a pose; others are not mapped.
std::vector<double> TimesOfMappedFrames(const MappingRun& run);

// How the mapper corrected wrong poses, one line each: slips and losses of SLAM.
std::vector<std::string> MendedPoses(const std::vector<FrameReport>& reports);

// The parts whose place in the map remained a guess, one line each.
std::vector<std::string> GuessWarnings(const std::vector<GuessedFrames>& guessed);

// The parts in which nothing tells whether the map or SLAM is right, one line each.
std::vector<std::string> AstrayWarnings(const std::vector<AstrayFrames>& astray);

// What a sequence is mapped with besides its frames.
struct MappingInputs {
  Trajectory final_poses = {};  // SLAM's own final trajectory, empty if there is none
  Progress progress = {};
  // As for FrameRecorder.
  GainOracle oracle = {};
  MatchOracle match_oracle = {};
  const PriorMap* prior = nullptr;  // a finished map to continue in, null if there is none
};

// Maps all frames of a source.
MappingRun MapFrames(FrameSource& source, const MapperOptions& options,
                     const MappingInputs& inputs);

// Poses as in the run's trajectory files; frames without a pose are absent. Those of a source
// without a camera are planar poses of the base (x, y, yaw about z, at height 0), as in a laser
// log's odometry.
Trajectory SlamTrajectory(const MappingRun& run);    // the input, live
Trajectory OnlineTrajectory(const MappingRun& run);  // estimates as known at the time
Trajectory FinalTrajectory(const MappingRun& run);   // estimates after all corrections

}  // namespace depthgrid
