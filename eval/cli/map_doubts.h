// Warnings about a run of `depthgrid map` that ended: its map may be wrong, but looks like any
// other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/cli/map_input.h"
#include "eval/cli/map_settings.h"
#include "eval/doubts/crossing_check.h"
#include "eval/run/mapping_run.h"

namespace depthgrid::cli {

// Warns of poses that do not fit the images; known before the run.
std::optional<std::string> DoubtOfGivenPoses(const MapArguments& arguments,
                                             const Sequence& sequence);

// `crossing`: the run's, if any. `arguments`, in the request, are completed from a run.yaml;
// `given` are not.
std::vector<std::string> DoubtsOfMapRun(const MapArguments& given, const MapRequest& request,
                                        const MapInput& input, const MappingRun& run,
                                        const std::optional<Crossing>& crossing);

}  // namespace depthgrid::cli
