// The first step of FindPlace(): scores a few returns at a lattice of positions and headings over
// the whole map.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"
#include "mapper/match/distance_field.h"

namespace depthgrid {

// A return and the position of the sensor; metres, in base axes of the first scan.
struct PlaceReturn {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};
using PlaceReturns = std::vector<PlaceReturn>;

struct PlaceCandidate {
  Pose2 map_from_first;
  double score = 0.0;  // 0..1
};

// Sigma of the score's Gaussian in the distance of a return from a wall.
inline constexpr double kCoarseSigmaM = 0.15;
// Weight of free space along a beam relative to its end: walls alone fit in many places, even
// outside the map, where there is no free space.
inline constexpr double kFreeWorth = 0.5;

// The best places, at most sixty, unordered. Uses at most half a gigabyte.
std::vector<PlaceCandidate> BestOnLattice(const OccupancyMap& map, const DistanceField& walls,
                                          const PlaceReturns& returns);

}  // namespace depthgrid
