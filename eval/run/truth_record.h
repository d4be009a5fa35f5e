// Ground truth of a run.
#pragma once

#include <optional>
#include <string>

#include "eval/run/world.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

struct TruthRecord {
  Trajectory trajectory;
  StateMap map;
  std::optional<CellSet> observable;
};

// Band, ranges and resolution are the mapper's settings: they define what the map shows. `threads`
// affects only the speed. Throws InputError for settings of the scans that contradict each other,
// naming the keys, and for a path that makes the map absurdly large.
TruthRecord MakeTruth(const World& world, const MapperOptions& options, int threads);

// truth_map.yaml/.pgm and observable.yaml/.pgm, the latter's free cells being the observable ones.
void WriteTruthMaps(const std::string& folder, const TruthRecord& truth);

}  // namespace depthgrid
