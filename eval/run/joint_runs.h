// Experiments that see the same room through the same camera and differ in what SLAM says and how
// it is mapped: the images are made once and handed to all of them.
#pragma once

#include <string>
#include <vector>

#include "eval/run/experiment.h"

namespace depthgrid {

struct JointRun {
  ExperimentOptions options;  // as they took effect
  SlamOutput slam;
  MappingRun mapping;
  RunScores scores;
};

struct JointRuns {
  World world;
  TruthRecord truth;
  std::vector<JointRun> runs;
};

// Everything that experiments must have in common to run jointly, as text.
std::string SharedPart(const ExperimentOptions& options);

// One run an entry of `options`, which have one SharedPart and are not empty. Each comes out as it
// would alone.
JointRuns RunJointly(const std::vector<ExperimentOptions>& options, const RunContext& context);

}  // namespace depthgrid
