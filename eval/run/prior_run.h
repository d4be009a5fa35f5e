// A run's folder as the map that another run goes on from.
#pragma once

#include <optional>
#include <string>

#include "mapper/incremental_mapper.h"

namespace depthgrid {

// Setting `submap.scans` of a run that goes on in a map: the last two submaps hold all of it.
constexpr int kAllScansInOneSubmap = 1'000'000;

// The stored scans of a folder that `run` or `map` wrote, numbered from below 0. Throws InputError,
// also for settings in its run.yaml that no map can have been made with.
PriorMap ReadPriorRun(const std::string& folder);

// Of the scans of that folder: what a run that goes on from there depends on.
std::string HashOfPriorRun(const std::string& folder);

// Where that run's map was made with other settings than it goes on with: the mapper's method, its
// grid, and with `images` the scans; others may differ.
std::optional<std::string> DoubtOfPrior(const std::string& folder, const MapperOptions& options,
                                        bool images);

// How high the camera was above the floor in the median frame of the last drive that added to the
// map; none of a laser's, of a run that was only localised, and where the folder does not tell.
std::optional<double> CameraHeightOfPrior(const std::string& folder);

}  // namespace depthgrid
