// How far a point of a map is from the nearest wall.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// Where along its way a beam asks whether the map is free.
inline constexpr double kOnTheWay[] = {0.3, 0.6, 0.85};

class DistanceField {
 public:
  // Distances are cut at `farthest_m`.
  DistanceField(const OccupancyMap& map, double farthest_m);

  // Whether there is a wall at all.
  bool any() const { return any_; }
  // From the middle of the point's cell to that of the nearest wall's, metres, within 8 %;
  // the farthest outside of the map.
  double At(const Eigen::Vector2d& point_m) const {
    const Cell cell = CellOf(point_m, geometry_.resolution_m);
    return geometry_.Contains(cell) ? distance_m_[geometry_.Index(cell)] : farthest_m_;
  }
  // 1 free, 0 not seen, -1 a wall.
  int FreeAt(const Eigen::Vector2d& point_m) const {
    const Cell cell = CellOf(point_m, geometry_.resolution_m);
    if (!geometry_.Contains(cell)) return 0;
    const CellState state = states_[geometry_.Index(cell)];
    return state == CellState::kUnknown ? 0 : state == CellState::kFree ? 1 : -1;
  }

 private:
  // A chamfer sweep (Borgefors 1986, weights 1 and sqrt 2), from one corner to the opposite one: 1
  // or -1.
  void Sweep(int way);

  GridGeometry geometry_;
  double farthest_m_;
  std::vector<float> distance_m_;
  std::vector<CellState> states_;
  bool any_ = false;
};

}  // namespace depthgrid
