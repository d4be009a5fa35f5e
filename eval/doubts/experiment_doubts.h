// What may be wrong with the run of an experiment, whose truth is known.
#pragma once

#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "eval/run/mapping_run.h"
#include "eval/run/truth_record.h"
#include "eval/run/world.h"

namespace depthgrid {

// Of its scene, its images, its map and its true map (DoubtOfUnits, DoubtOfView, DoubtOfCrossing,
// DoubtOfTruth): one line each.
std::vector<std::string> DoubtsOfExperiment(const World& world, const MappingRun& run,
                                            const TruthRecord& truth,
                                            const ExperimentOptions& options);

}  // namespace depthgrid
