// Whether what is seen from a place agrees with a finished map, beam by beam.
#pragma once

#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"
#include "mapper/match/distance_field.h"

namespace depthgrid {

// Beams that agree with the map or contradict it, of as many scans as were added.
struct MapAgreement {
  int beams = 0;    // that were compared: every fourth with a return
  int on_wall = 0;  // of these: their ends
  int against = 0;  // that end where the map is free, or behind a wall of it

  // a / (a + c + b / 10): what the map does not know counts little, a robot may leave it.
  double share() const;
  // c / (a + c).
  double share_against() const;
};

// A wall of the map is looked for this far from a return.
constexpr double kOffWallM = 0.3;

// `walls` must reach farther than kOffWallM.
void Compare(const Scan& scan, const Pose2& map_from_base, const DistanceField& walls,
             MapAgreement& agreement);

}  // namespace depthgrid
