// The first step of FindPlace(): a few returns laid over the whole map, at places and headings on a
// lattice.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"
#include "mapper/match/distance_field.h"

namespace depthgrid {

// A return, with the sensor that saw it; metres, in the axes of the first scan's base.
struct PlaceReturn {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};
using PlaceReturns = std::vector<PlaceReturn>;

struct PlaceCandidate {
  Pose2 map_from_first;
  double score = 0.0;  // 0..1
};

// A return this far from a wall still counts exp(-1/2).
inline constexpr double kCoarseSigmaM = 0.15;
// What free space on a beam's way is worth beside its end: walls alone fit in many places, also
// outside of the map, where no free space does.
inline constexpr double kFreeWorth = 0.5;

// The best places, sixty at most, in no order that matters. Takes half a gigabyte at most.
std::vector<PlaceCandidate> BestOnLattice(const OccupancyMap& map, const DistanceField& walls,
                                          const PlaceReturns& returns);

}  // namespace depthgrid
