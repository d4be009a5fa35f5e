// A run's folder as the map that another run goes on from.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/incremental_mapper.h"
#include "mapper/match/find_place.h"

namespace depthgrid {

// The stored scans of a folder that `run` or `map` wrote, numbered from below 0. Throws InputError.
PriorMap ReadPriorRun(const std::string& folder);

// Where `source`, read from its beginning for a few metres, begins in the map. Nothing when
// no scan of it shows anything.
std::optional<FoundPlace> FindStart(const PriorMap& prior, FrameSource& source,
                                    const MapperOptions& options);

}  // namespace depthgrid
