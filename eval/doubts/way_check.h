// Whether SLAM and the scans agree on the length and direction of motion.
#pragma once

#include <optional>

#include "eval/run/mapping_run.h"

namespace depthgrid {

// Path lengths of SLAM's poses and the final estimates over the same stretches.
struct Ways {
  double slam_m = 0.0;
  double map_m = 0.0;
};

// Summed over stretches (StretchesOf) of at least half a metre in either.
Ways WaysOf(const MappingRun& run);

// The lengths, if they differ so much that one of the scales must be wrong: depth images in other
// units, monocular SLAM, or a wrong wheel size. Empty for short paths.
std::optional<Ways> ScaleDoubt(const MappingRun& run);

// The ratio of the map's turns to SLAM's on the same stretches, if it is so far from 1 that
// headings or the scans' angles must have a wrong scale, such as a wrong field of view of the
// laser, however noisy either is. Empty for less than half a turn.
std::optional<double> TurnScaleDoubt(const MappingRun& run);

// Why SLAM and the scans move in different directions.
enum class WayFault {
  kMirroredScans,  // readings in reverse order: the same motion with left and right swapped
  kTurns,          // headings with the wrong sign
  kDirections,     // x and y swapped, or headings counted from another axis
};

// For planar sequences, whose scans alone determine the laser's motion. Empty for short paths;
// turns are judged only from a quarter turn on.
std::optional<WayFault> WayDoubt(const MappingRun& run);

}  // namespace depthgrid
