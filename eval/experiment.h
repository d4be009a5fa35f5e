// One experiment from the room to the scores, in memory.
#pragma once

#include <optional>

#include "eval/experiment_options.h"
#include "eval/mapping_run.h"
#include "eval/metrics/map_metrics.h"
#include "eval/metrics/trajectory_metrics.h"
#include "eval/world.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// What is known of the true world of a run.
struct TruthRecord {
  Trajectory trajectory;
  StateMap map;
  std::optional<CellSet> observable;
};

struct RunScores {
  std::optional<TrajectoryScore> slam;    // the input, live
  std::optional<TrajectoryScore> online;  // the estimate as known at the time
  std::optional<TrajectoryScore> est;     // the estimate at the end
  MapScore map;
};

RunScores Score(const MappingRun& run, const TruthRecord& truth);

// What decides how fast, and nothing else.
struct RunContext {
  int threads = 1;
  Progress progress;
};

struct ExperimentRun {
  World world;
  SlamOutput slam;
  MappingRun mapping;
  TruthRecord truth;
  RunScores scores;
  double render_cpu_s = 0.0;
};

ExperimentRun RunExperiment(const ExperimentOptions& options, const RunContext& context);

}  // namespace depthgrid
