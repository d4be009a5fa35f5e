// Warnings of `depthgrid eval map` about maps that may not belong together.
#pragma once

#include <string>
#include <vector>

#include "eval/cli/compared_maps.h"
#include "eval/metrics/map_metrics.h"
#include "eval/metrics/map_registration.h"

namespace depthgrid::cli {

// `walls`: those of the estimate that were registered. The quality must have been scored.
std::vector<std::string> DoubtsOfComparison(const EvalMapArguments& arguments,
                                            const MapFiles& files, const ComparedMaps& maps,
                                            const PlacedWalls& walls, const MapScore& score);

}  // namespace depthgrid::cli
