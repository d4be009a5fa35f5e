// Reads a run's folder as the prior map of another run.
#pragma once

#include <optional>
#include <string>

#include "mapper/incremental_mapper.h"

namespace depthgrid {

// Value of `submap.scans` for a run that continues in a map, so that the last two submaps hold all
// scans.
constexpr int kAllScansInOneSubmap = 1'000'000;

// The stored scans of a folder that `run` or `map` wrote, with negative frame numbers. Throws
// InputError, also for impossible settings in its run.yaml.
PriorMap ReadPriorRun(const std::string& folder);

// Hash of the scans of that folder, on which a run that continues from it depends.
std::string HashOfPriorRun(const std::string& folder);

// A warning if that run's map was made with settings other than `options`: the mapper's method, its
// grid and, with `images`, the scans. Others may differ.
std::optional<std::string> DoubtOfPrior(const std::string& folder, const MapperOptions& options,
                                        bool images);

// Median height of the camera above the floor in the last run that added to the map. Empty for
// lasers, for runs that were only localised, and where the folder does not contain it.
std::optional<double> CameraHeightOfPrior(const std::string& folder);

}  // namespace depthgrid
