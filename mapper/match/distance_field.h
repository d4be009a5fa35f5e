// Distance of points of a map from the nearest wall.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// Fractions of a beam's range at which the map is checked for free space.
inline constexpr double kOnTheWay[] = {0.3, 0.6, 0.85};

class DistanceField {
 public:
  // Distances are limited to `farthest_m`.
  DistanceField(const OccupancyMap& map, double farthest_m);

  // Whether the map has any wall.
  bool any() const { return any_; }
  // Distance (m, within 8 %) between the centres of the point's cell and the nearest wall cell;
  // farthest_m outside the map.
  double At(const Eigen::Vector2d& point_m) const {
    const Cell cell = CellOf(point_m, geometry_.resolution_m);
    return geometry_.Contains(cell) ? distance_m_[geometry_.Index(cell)] : farthest_m_;
  }
  // 1: free, 0: unknown, -1: wall.
  int FreeAt(const Eigen::Vector2d& point_m) const {
    const Cell cell = CellOf(point_m, geometry_.resolution_m);
    if (!geometry_.Contains(cell)) return 0;
    const CellState state = states_[geometry_.Index(cell)];
    return state == CellState::kUnknown ? 0 : state == CellState::kFree ? 1 : -1;
  }

 private:
  // A chamfer sweep (Borgefors 1986, weights 1 and sqrt 2); `way` is 1 or -1, the direction between
  // opposite corners.
  void Sweep(int way);

  GridGeometry geometry_;
  double farthest_m_;
  std::vector<float> distance_m_;
  std::vector<CellState> states_;
  bool any_ = false;
};

}  // namespace depthgrid
