// Runs experiments that have the same room and camera and differ in SLAM and mapper: the images are
// made once and shared.
#pragma once

#include <string>
#include <vector>

#include "eval/run/experiment.h"

namespace depthgrid {

struct JointRun {
  ExperimentOptions options;  // as completed
  SlamOutput slam;
  MappingRun mapping;
  RunScores scores;
};

struct JointRuns {
  World world;
  TruthRecord truth;
  std::vector<JointRun> runs;
};

// The options that must be equal for experiments to run jointly, as text.
std::string SharedPart(const ExperimentOptions& options);

// One run per entry of `options`, which is not empty and whose SharedPart() must be equal. Results
// are the same as of separate runs.
JointRuns RunJointly(const std::vector<ExperimentOptions>& options, const RunContext& context);

}  // namespace depthgrid
