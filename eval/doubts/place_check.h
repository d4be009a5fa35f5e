// Whether a run that was begun in a finished map is where it thinks it is.
#pragma once

#include <optional>
#include <string>

#include "eval/run/mapping_run.h"
#include "mapper/grid/grid_options.h"
#include "mapper/match/find_place.h"
#include "mapper/match/map_agreement.h"

namespace depthgrid {

struct LostFrames {
  bool localised = false;  // else the first frame alone was looked at
  int lost = 0;            // of so many frames hardly anything that they show lies on the map
  int frames = 0;
  // Where the sequence left the map (FrameReport::index): 30 frames and more before it were on the
  // map, but for a tenth, and from it on 30 in a row are not. Empty where that cannot be told.
  std::optional<int> left_at;
  // The first 30 frames and the last 30 are on the map, but for a tenth.
  bool comes_back = false;
};

// Of the frames that were matched against the finished map alone: all where nothing was inserted
// (`localised`), else the first. Empty unless a tenth of them are lost.
std::optional<LostFrames> FramesLost(const MappingRun& run, bool localised);

// In words, for a warning about the map.
std::string TextOf(const LostFrames& lost);

// How all that a run added agrees with what the map held before, where much of it (as of a start,
// kMuchAgainst) contradicts that. `grid`: as the map is drawn. Empty where nothing was added.
std::optional<MapAgreement> Contradiction(const MappingRun& run, const GridOptions& grid);

// Whether any frame's match told its place along this line.
bool SeesAlong(const MappingRun& run, const UnsureAlong& line);

}  // namespace depthgrid
