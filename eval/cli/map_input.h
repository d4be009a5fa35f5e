// What `depthgrid map` reads before the first frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/cli/map_settings.h"
#include "mapper/io/sequence.h"
#include "mapper/map_start.h"

namespace depthgrid::cli {

struct MapInput {
  Sequence sequence;
  std::optional<PriorMap> prior;  // the finished map to continue in, if any
  std::string prior_hash;         // of the run that made it; empty without one
  std::optional<MapStart> start;  // in that map
  std::vector<std::string> warnings;
};

// Opens the sequence and the finished map, finds where the sequence starts in it, and prints what
// was found. Completes the request's settings: the floor's height, and what follows from the
// finished map.
MapInput OpenMapInput(const MapArguments& given, MapRequest& request);

}  // namespace depthgrid::cli
