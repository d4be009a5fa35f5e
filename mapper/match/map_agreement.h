// Compares scans with a finished map, beam by beam.
#pragma once

#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"
#include "mapper/match/distance_field.h"

namespace depthgrid {

// Counts of beams that agree with the map or contradict it, over all scans compared.
struct MapAgreement {
  int beams = 0;    // compared: every fourth with a return
  int on_wall = 0;  // of these, ends on a wall
  int against = 0;  // of these, ends in free space or behind a wall

  // on_wall / (on_wall + against + beams / 10): unknown space counts little, as a robot may leave
  // the map.
  double share() const;
  // against / (on_wall + against).
  double share_against() const;
};

// A return in free space farther than this from any wall contradicts the map.
constexpr double kOffWallM = 0.3;

// `walls` must reach farther than kOffWallM.
void Compare(const Scan& scan, const Pose2& map_from_base, const DistanceField& walls,
             MapAgreement& agreement);

}  // namespace depthgrid
