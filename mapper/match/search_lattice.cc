#include "mapper/match/search_lattice.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "mapper/core/error.h"

namespace depthgrid {

bool PrecedesInLattice(const LatticeStep& a, const LatticeStep& b) {
  const auto rank = [](const LatticeStep& s) {
    return std::make_tuple(std::abs(s.yaw_steps), s.yaw_steps,
                           s.x_cells * s.x_cells + s.y_cells * s.y_cells, s.y_cells, s.x_cells);
  };
  return rank(a) < rank(b);
}

SearchLattice MakeLattice(const Pose2& predicted_map_from_base, double window_m, double window_rad,
                          double resolution_m, double farthest_m) {
  Require(resolution_m > 0.0, "a searched grid has a resolution");
  // Lower bound of the distance, as in Cartographer: nearer points would make the step uselessly
  // large.
  constexpr double kNearestUsedCells = 3.0;
  // Keeps the motion of the farthest point strictly below one cell.
  constexpr double kSafety = 1.0 - 1e-3;
  const double distance_m = std::max(farthest_m, kNearestUsedCells * resolution_m);
  const double ratio = resolution_m / distance_m;
  SearchLattice lattice;
  lattice.predicted_map_from_base = predicted_map_from_base;
  lattice.resolution_m = resolution_m;
  lattice.yaw_step_rad = kSafety * std::acos(1.0 - 0.5 * ratio * ratio);
  // A window of a whole number of steps must not gain one by rounding.
  constexpr double kRounding = 1e-9;
  lattice.half_cells = static_cast<int>(std::ceil(window_m / resolution_m - kRounding));
  lattice.half_yaw_steps =
      static_cast<int>(std::ceil(window_rad / lattice.yaw_step_rad - kRounding));
  return lattice;
}

PointCells::PointCells(const Pose2& map_from_base, double resolution_m)
    : cos_cells_per_m(static_cast<float>(std::cos(map_from_base.yaw_rad) / resolution_m)),
      sin_cells_per_m(static_cast<float>(std::sin(map_from_base.yaw_rad) / resolution_m)),
      whole_cells(CellOf(map_from_base.translation(), resolution_m)) {
  x_remainder_cells = static_cast<float>(map_from_base.x_m / resolution_m - whole_cells.x);
  y_remainder_cells = static_cast<float>(map_from_base.y_m / resolution_m - whole_cells.y);
}

std::uint32_t LatticeScore(const SearchLattice& lattice, const LatticeStep& step,
                           const MatchPoints& points, const ProbabilityView& view) {
  const PointCells cells = lattice.CellsAt(step.yaw_steps);
  const Cell shift{cells.whole_cells.x + step.x_cells, cells.whole_cells.y + step.y_cells};
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    const Cell cell{shift.x + static_cast<int>(cells.X(points.x_m[i], points.y_m[i])),
                    shift.y + static_cast<int>(cells.Y(points.x_m[i], points.y_m[i]))};
    sum += QuantisedProb(view.At(cell));
  }
  return sum;
}

}  // namespace depthgrid
