// Whether a run's depth images showed anything to map or to match, and why they did not.
#pragma once

#include <optional>
#include <string>

#include "eval/experiment/experiment_options.h"
#include "eval/run/mapping_run.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

// Whether the run drew no wall: none of its own scans has a hit.
bool SawNothing(const MappingRun& run);

// What to say when the map is empty or has no free cell, when nothing could be matched since no
// scan has a hit at the camera's height, or when so few frames could that the poses are mostly
// those given: the band, the ranges, the images. Nothing of laser logs.
std::optional<std::string> DoubtOfView(const MappingRun& run, const MapperOptions& options);

// The same of an experiment, whose path may be at fault where it is a file's.
std::optional<std::string> DoubtOfView(const MappingRun& run, const ExperimentOptions& options);

// Of laser logs: what to say when so few scans could be matched that the poses are mostly those
// given.
std::optional<std::string> DoubtOfScans(const MappingRun& run);

}  // namespace depthgrid
