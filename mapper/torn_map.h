// Finds where a finished map is torn: two parts of it, each right in itself, of which the later one
// lies elsewhere than it belongs, because nothing told the position on the way from one to the
// other (docs/math.md, "Torn maps").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/guessed_part.h"
#include "mapper/graph/loop_search_options.h"

namespace depthgrid {

// How a tear may be mended.
struct Mending {
  PlanarLoop loop;  // between frames before and after it that saw the same
  // Of all frames: those after it moved to where they belong, and those within in part.
  std::vector<Pose2> map_from_base;
};

// Of the tears across which the map contradicts itself most. None moves what a prior map has, or
// leaves a guessed part. `search`: how well two places must fit for a loop as accurate as those.
std::vector<Mending> MendingsOf(const std::vector<MappedFrame>& frames,
                                const LoopSearchOptions& search, const OverlapOptions& overlap,
                                const std::vector<GuessedPart>& guessed = {});

}  // namespace depthgrid
