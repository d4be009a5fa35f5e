// Where walls lie within their cells: for each cell near hits, the mean signed distance of its
// centre behind the wall (docs/math.md, "Where a wall lies within its cells").
#pragma once

#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"
#include "mapper/grid/wall_normals.h"

namespace depthgrid {

// Distance of a cell's centre behind the wall of a hit, negative before it.
struct WallDistance {
  Cell cell;
  float behind_m = 0.0F;
};

// Memory for FindWallDistances, kept from scan to scan.
struct WallMemory {
  std::vector<WallHit> hits;
  std::vector<WallDistance> distances;
};

// The distances of the cells that a scan's beams cross near their hits. Valid until the memory is
// reused.
const std::vector<WallDistance>& FindWallDistances(const Scan& scan, const Pose2& map_from_base,
                                                   double resolution_m, WallMemory& memory);

class WallDistances {
 public:
  // `wall_prob` is the probability of a cell whose centre lies on a wall, `free_prob` that of one
  // far from it.
  WallDistances(double resolution_m, double free_prob, double wall_prob);

  void Insert(const std::vector<WallDistance>& distances);
  // The map with the cells near walls replaced; `drawn` keeps its memory.
  void DrawOver(const OccupancyMap& map, OccupancyMap& drawn) const;

 private:
  void GrowToContain(const std::vector<WallDistance>& distances);

  double free_prob_;
  double wall_prob_;
  GridGeometry geometry_;
  std::vector<float> sum_m_;  // sum of a cell's distances; geometry_.size()
  std::vector<float> count_;  // number of distances
};

}  // namespace depthgrid
