// Which scans lead through walls of the map drawn from them: where they do, poses are wrong.
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"
#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// A scan laid into the map at its pose.
struct CrossedWalls {
  int mapped = 0;  // index of its frame
  int beams = 0;   // examined, with a hit
  // Of these, those that lead through a wall of the map where they say that the way is free, and
  // end farther than the tolerance behind it, as does the next beam (a single one may be a wrong
  // reading). Walls met at less than 45 degrees do not count.
  int crossing = 0;

  double share() const { return beams > 0 ? static_cast<double>(crossing) / beams : 0.0; }
};

// How much is examined, at most: scans evenly spread over the frames, beams evenly spread over
// each.
struct CrossedWallsSample {
  std::size_t scans = 600;
  std::size_t beams = 160;
};

// Of the kept scans, without those of a prior map, in order. The tolerance is two cells, or three
// times the beams' noise at their range where that is more (BeamNoise).
std::vector<CrossedWalls> WallsCrossed(const std::vector<MappedFrame>& frames,
                                       const OccupancyMap& map,
                                       const CrossedWallsSample& sample = {});

// From this share on walls are drawn twice. Of 420 runs through random buildings and 68 of other
// laser logs all that have more end 7 cm off or farther; depth cameras have up to 6 % where a ramp
// rises into the obstacle band (docs/results.md, "Scans against their map").
constexpr double kDoubledShare = 0.02;

// Of all beams examined; 0 if there are none.
double CrossingShare(const std::vector<CrossedWalls>& scans);

}  // namespace depthgrid
