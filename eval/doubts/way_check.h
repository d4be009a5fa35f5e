// Whether SLAM and the scans agree on how far the camera went, and which way.
#pragma once

#include <optional>

#include "eval/run/mapping_run.h"

namespace depthgrid {

// How far SLAM's poses and the final estimates go over the same stretches.
struct Ways {
  double slam_m = 0.0;
  double map_m = 0.0;
};

// Summed over stretches of at least half a metre of either, none across a correction of SLAM, as
// SlamEpochs tells it, or where a pose is missing.
Ways WaysOf(const MappingRun& run);

// The ways, where they differ so much that one of the two scales is wrong: depth images read in
// other units than they have, a monocular SLAM, wheels of another size. Nothing for short ways.
std::optional<Ways> ScaleDoubt(const MappingRun& run);

// The map's turns over SLAM's on the same stretches, where they differ so much that headings or the
// scans' angles have another scale: a laser that is wider or narrower than was read. Nothing for
// less than half a turn.
std::optional<double> TurnScaleDoubt(const MappingRun& run);

// What makes the two go different ways.
enum class WayFault {
  kMirroredScans,  // readings from the other side: both go the same way, but for left and right
  kTurns,          // headings with the other sign
  kDirections,     // x and y swapped, or headings counted from another axis
};

// Of planar sequences, whose scans say by themselves how the laser moves. Nothing for short ways
// and, of turns, for less than a quarter turn.
std::optional<WayFault> WayDoubt(const MappingRun& run);

}  // namespace depthgrid
