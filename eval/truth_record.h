// What is known of the true world of a run.
#pragma once

#include <optional>
#include <string>

#include "eval/world.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

struct TruthRecord {
  Trajectory trajectory;
  StateMap map;
  std::optional<CellSet> observable;
};

// Throws InputError naming the keys when settings of the scans contradict each other.
void RequireUsableScans(const World& world, const MapperOptions& options);

// Band, ranges and resolution are the mapper's settings: they say what the map is a map of.
// `threads` only changes the speed.
TruthRecord MakeTruth(const World& world, const MapperOptions& options, int threads);

// truth_map.yaml/.pgm and observable.yaml/.pgm, the latter's free cells being the observable ones.
void WriteTruthMaps(const std::string& folder, const TruthRecord& truth);

}  // namespace depthgrid
