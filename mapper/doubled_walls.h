// Finds out where a finished map shows one place twice (docs/math.md, "Walls drawn twice").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/guessed_part.h"
#include "mapper/graph/loop_search_options.h"
#include "mapper/grid/crossed_walls.h"

namespace depthgrid {

// What is examined of a map before poses are final: 3 to 12 ms.
constexpr CrossedWallsSample kDoubledSample{300, 80};

// A loop from a scan that leads through many walls to another time at which its place was seen, if
// one is found that asks for a correction (`search.min_correction_*`). `crossed`: of the map drawn
// from these frames. No loop leaves a guessed part: it may lie anywhere, not only as near as what
// drift shows twice.
std::optional<PlanarLoop> LoopOfDoubledWalls(const std::vector<MappedFrame>& frames,
                                             std::vector<CrossedWalls> crossed,
                                             const LoopSearchOptions& search,
                                             const OverlapOptions& overlap,
                                             const std::vector<GuessedPart>& guessed = {});

}  // namespace depthgrid
