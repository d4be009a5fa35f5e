// Runs one experiment in memory, from the room to the scores.
#pragma once

#include <optional>
#include <string>

#include "eval/experiment/experiment_options.h"
#include "eval/metrics/map_metrics.h"
#include "eval/metrics/trajectory_metrics.h"
#include "eval/run/consistency.h"
#include "eval/run/mapping_run.h"
#include "eval/run/truth_record.h"
#include "eval/run/world.h"

namespace depthgrid {

struct RunScores {
  std::optional<TrajectoryScore> slam;    // the input, live
  std::optional<TrajectoryScore> online;  // the mapper's estimate at each frame
  std::optional<TrajectoryScore> est;     // the mapper's final estimate
  MapScore map;
  ConsistencyScores consistency;
};

RunScores Score(const MappingRun& run, const TruthRecord& truth,
                const MetricsOptions& options = {});

// Affects only the speed.
struct RunContext {
  int threads = 1;
  std::string cache_folder;  // of rendered depth; empty for none
  Progress progress;
};

struct ExperimentRun {
  ExperimentOptions options;  // as completed
  World world;
  SlamOutput slam;
  MappingRun mapping;
  TruthRecord truth;
  RunScores scores;
};

// Fills in what follows from the scene: the height of its floor.
ExperimentOptions Completed(ExperimentOptions options, const Scene& scene);

// For fusion.mode `oracle`. The surrogate's coordinate frame is the true world's, so a frame's true
// pose is its pose in the map. `truth` must outlive the result.
GainOracle OracleOf(const Trajectory& truth);

// The mapping of an experiment whose frames come from `source`.
MappingRun MapExperiment(FrameSource& source, const ExperimentOptions& completed,
                         const World& world, const SlamOutput& slam, const Progress& progress);

ExperimentRun RunExperiment(const ExperimentOptions& options, const RunContext& context);

}  // namespace depthgrid
