// Whether a run that started in a finished map is located correctly in it.
#pragma once

#include <optional>
#include <string>

#include "eval/run/mapping_run.h"
#include "mapper/grid/grid_options.h"
#include "mapper/match/find_place.h"
#include "mapper/match/map_agreement.h"

namespace depthgrid {

struct LostFrames {
  bool localised = false;  // else only the first frame was checked
  int lost = 0;            // frames of which hardly any hits lie on the map
  int frames = 0;
  // Where the sequence left the map (FrameReport::index): of at least 30 frames before it, 90 %
  // were on the map, and from it on 30 in a row are not. Empty if there is no such frame.
  std::optional<int> left_at;
  // Of the first 30 and of the last 30 frames, 90 % are on the map.
  bool comes_back = false;
};

// Checks the frames that were matched only against the finished map: all if nothing was inserted
// (`localised`), else the first. Empty unless a tenth of them are lost.
std::optional<LostFrames> FramesLost(const MappingRun& run, bool localised);

// The text of a warning about it.
std::string TextOf(const LostFrames& lost);

// How far from a given start a run begins by its final poses.
struct MovedStart {
  Pose2 found;  // of the robot's base at the first frame with a pose and a scan
  Pose2 move;   // from the given one to it
};

// `given`: of the robot's base in the map. Empty for differences up to 5 cm and 3 degrees, by which
// scans refine any start, and where no frame has pose and scan.
std::optional<MovedStart> StartMoved(const MappingRun& run, const Pose2& given);

// How all that a run added agrees with the map as it was, at final poses. `grid`: as the map is
// drawn. Above kMuchAgainst, the limit for a start, it lies at a wrong place or much has changed.
MapAgreement AgreementWithEarlier(const MappingRun& run, const GridOptions& grid);

// Whether any frame's match determined its position along this line.
bool SeesAlong(const MappingRun& run, const UnsureAlong& line);

}  // namespace depthgrid
