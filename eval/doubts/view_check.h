// Whether a run's depth images showed anything to map or to match, and why they did not.
#pragma once

#include <optional>
#include <string>

#include "eval/experiment/experiment_options.h"
#include "eval/run/mapping_run.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

// Whether none of the run's own scans has a hit.
bool SawNothing(const MappingRun& run);

// A warning when the map is empty or has no free cell, when nothing could be matched because no
// scan has a hit at the camera's height, or when so few frames were matched that the poses are
// mostly the given ones. It names the cause: band, ranges or images. Empty for laser logs.
std::optional<std::string> DoubtOfView(const MappingRun& run, const MapperOptions& options);

// The same for an experiment; also names its path as a possible cause if it is from a file.
std::optional<std::string> DoubtOfView(const MappingRun& run, const ExperimentOptions& options);

// For laser logs: a warning when so few scans were matched that the poses are mostly the given
// ones.
std::optional<std::string> DoubtOfScans(const MappingRun& run);

}  // namespace depthgrid
