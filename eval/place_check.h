// Whether a run that was begun in a finished map is where it thinks it is.
#pragma once

#include <optional>

#include "eval/mapping_run.h"
#include "mapper/match/find_place.h"

namespace depthgrid {

struct LostFrames {
  int lost = 0;  // of so many frames hardly anything that they show lies on the map
  int frames = 0;
  // Before this one (FrameReport::index) a second of frames or more were on the map, but for a
  // tenth: the sequence left it there. Negative: it was hardly ever on it.
  int left_at = -1;
};

// Of the frames that were matched against the finished map alone: all where nothing was inserted
// (`localised`), else the first. Empty unless a tenth of them are lost.
std::optional<LostFrames> FramesLost(const MappingRun& run, bool localised);

// Whether any frame's match told its place along this line.
bool SeesAlong(const MappingRun& run, const UnsureAlong& line);

}  // namespace depthgrid
