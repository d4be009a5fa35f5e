// Whether the true map can be one of the room that is meant.
#pragma once

#include <optional>
#include <string>

#include "eval/experiment/experiment_options.h"
#include "eval/run/truth_record.h"
#include "eval/run/world.h"

namespace depthgrid {

bool HasFree(const StateMap& map);

// What to say when nothing of the true map is free, or most of the camera's path lies in what is
// not: the scene's faces or its floor.
std::optional<std::string> DoubtOfTruth(const TruthRecord& truth, const ExperimentOptions& options);

// That the true map is of another storey than the path (eval/doubts/storey_check.h).
std::optional<std::string> DoubtOfStorey(const World& world, const ExperimentOptions& options);

// The latter, or else the former: a floor in another storey explains a path that is not free.
std::optional<std::string> DoubtOfTruth(const World& world, const TruthRecord& truth,
                                        const ExperimentOptions& options);

}  // namespace depthgrid
