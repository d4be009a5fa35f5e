// Where walls lie within their cells: of each cell near a hit, the mean distance of its centre
// behind the hits, along their beams (docs/math.md, "Where a wall lies within its cells").
#pragma once

#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"

namespace depthgrid {

class WallDistances {
 public:
  // `wall_prob` is the probability of a cell whose centre lies on a wall, `free_prob` that of one
  // far from it.
  WallDistances(double resolution_m, double free_prob, double wall_prob);

  void Insert(const Scan& scan, const Pose2& map_from_base);
  // The map with the cells near walls replaced.
  OccupancyMap DrawnOver(const OccupancyMap& map) const;

 private:
  struct Mean {
    float sum_m = 0.0F;
    float count = 0.0F;
  };
  void GrowToContain(const std::vector<Eigen::Vector2d>& points_in_map);

  double free_prob_;
  double wall_prob_;
  GridGeometry geometry_;
  std::vector<Mean> means_;  // geometry_.size()
  std::vector<Eigen::Vector2d> hits_in_map_;
};

}  // namespace depthgrid
