// Whether the true map is plausible for the room.
#pragma once

#include <optional>
#include <string>

#include "eval/experiment/experiment_options.h"
#include "eval/run/truth_record.h"
#include "eval/run/world.h"

namespace depthgrid {

bool HasFree(const StateMap& map);

// A warning when the true map has no free cell, or when most of the camera's path is outside the
// free cells, because of the scene's faces or its floor.
std::optional<std::string> DoubtOfTruth(const TruthRecord& truth, const ExperimentOptions& options);

// A warning that the true map is of another storey than the path (eval/doubts/storey_check.h).
std::optional<std::string> DoubtOfStorey(const World& world, const ExperimentOptions& options);

// The second, or else the first: a floor on another storey explains a path that is not free.
std::optional<std::string> DoubtOfTruth(const World& world, const TruthRecord& truth,
                                        const ExperimentOptions& options);

}  // namespace depthgrid
