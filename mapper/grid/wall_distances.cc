#include "mapper/grid/wall_distances.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mapper/grid/wall_normals.h"

namespace depthgrid {
namespace {

// A hit tells its distance to the cells its beam crosses this far before and behind it: as far as
// the bicubic interpolation around the wall reaches.
constexpr int kReachCells = 2;
constexpr int kStepsPerCell = 2;
// A wall's direction is that of the hits this far to either side.
constexpr double kNormalReachCells = 2.0;
// Of the bell that distances become probabilities by, in cells: wide enough that bicubic
// interpolation finds its top within a fifth of a cell.
constexpr double kBellCells = 1.0;
// The rectangle grows by at least this much at a time.
constexpr int kGrowthCells = 32;

}  // namespace

WallDistances::WallDistances(double resolution_m, double free_prob, double wall_prob)
    : free_prob_(free_prob), wall_prob_(wall_prob) {
  geometry_.resolution_m = resolution_m;
}

void WallDistances::GrowToContain(const std::vector<Eigen::Vector2d>& points_in_map) {
  GridGeometry needed = geometry_;
  needed.width_cells = needed.height_cells = 0;
  for (const Eigen::Vector2d& point : points_in_map) {
    GridGeometry around = geometry_;
    around.min_cell = CellOf(point, geometry_.resolution_m);
    around.min_cell.x -= kReachCells + 1;
    around.min_cell.y -= kReachCells + 1;
    around.width_cells = around.height_cells = 2 * (kReachCells + 1) + 1;
    needed = Union(needed, around);
  }
  if (Union(geometry_, needed) == geometry_) return;
  needed.min_cell.x -= kGrowthCells;
  needed.min_cell.y -= kGrowthCells;
  needed.width_cells += 2 * kGrowthCells;
  needed.height_cells += 2 * kGrowthCells;
  const GridGeometry grown = Union(geometry_, needed);
  std::vector<Mean> moved(grown.size());
  for (std::size_t i = 0; i < means_.size(); ++i)
    moved[grown.Index(geometry_.CellAt(i))] = means_[i];
  means_ = std::move(moved);
  geometry_ = grown;
}

void WallDistances::Insert(const Scan& scan, const Pose2& map_from_base) {
  const double resolution_m = geometry_.resolution_m;
  const std::vector<WallHit> hits = WallHits(scan, kNormalReachCells * resolution_m);
  if (hits.empty()) return;
  hits_in_map_.clear();
  for (const WallHit& hit : hits) hits_in_map_.push_back(map_from_base * hit.point);
  GrowToContain(hits_in_map_);
  const Eigen::Rotation2Dd turn(map_from_base.yaw_rad);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Eigen::Vector2d& hit = hits_in_map_[i];
    const Eigen::Vector2d normal = turn * hits[i].normal;
    const Eigen::Vector2d along = (hit - map_from_base.translation()).normalized();
    Cell last = CellOf(hit - (kReachCells + 1) * resolution_m * along, resolution_m);
    for (int step = -kReachCells * kStepsPerCell; step <= kReachCells * kStepsPerCell; ++step) {
      const double from_hit_m = step * resolution_m / kStepsPerCell;
      const Cell cell = CellOf(hit + from_hit_m * along, resolution_m);
      if (cell == last) continue;
      last = cell;
      Mean& mean = means_[geometry_.Index(cell)];
      mean.sum_m += static_cast<float>((CellCentre(cell, resolution_m) - hit).dot(normal));
      mean.count += 1.0F;
    }
  }
}

OccupancyMap WallDistances::DrawnOver(const OccupancyMap& map) const {
  OccupancyMap drawn(Union(map.geometry, geometry_));
  for (int row = 0; row < map.geometry.height_cells; ++row) {
    const Cell first{map.geometry.min_cell.x, map.geometry.min_cell.y + row};
    const auto source =
        map.occupied_prob.begin() + static_cast<std::ptrdiff_t>(map.geometry.Index(first));
    std::copy(
        source, source + map.geometry.width_cells,
        drawn.occupied_prob.begin() + static_cast<std::ptrdiff_t>(drawn.geometry.Index(first)));
  }
  const double bell_m = kBellCells * geometry_.resolution_m;
  for (std::size_t i = 0; i < means_.size(); ++i) {
    if (means_[i].count == 0.0F) continue;
    const double in_bells = means_[i].sum_m / means_[i].count / bell_m;
    drawn.occupied_prob[drawn.geometry.Index(geometry_.CellAt(i))] = static_cast<float>(
        free_prob_ + (wall_prob_ - free_prob_) * std::exp(-0.5 * in_bells * in_bells));
  }
  return drawn;
}

}  // namespace depthgrid
