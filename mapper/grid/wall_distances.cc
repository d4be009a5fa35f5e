#include "mapper/grid/wall_distances.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace depthgrid {
namespace {

// A hit updates the distances of the cells along its beam this far in front of and behind it, the
// reach of bicubic interpolation around the wall.
constexpr int kReachCells = 2;
constexpr int kStepsPerCell = 2;
// A wall's direction is fitted to the hits this far to either side.
constexpr double kNormalReachCells = 2.0;
// The distance at which the parabola that maps distance to probability reaches free space.
// Catmull-Rom interpolation is exact for parabolas, so the ridge of the map lies exactly on the
// wall. The four cells around a wall are within two of it, but 1.75 was better than 1.5, 2 and 2.25
// (docs/tried.md, "The paper's experiment").
constexpr double kFreeFromCells = 1.75;
// The rectangle grows by at least this much.
constexpr int kGrowthCells = 32;

}  // namespace

const std::vector<WallDistance>& FindWallDistances(const Scan& scan, const Pose2& map_from_base,
                                                   double resolution_m, WallMemory& memory) {
  FindWallHits(scan, kNormalReachCells * resolution_m, memory.hits);
  memory.distances.clear();
  constexpr double kOneCell = 1.0;  // the unit of length below
  const Eigen::Rotation2Dd turn(map_from_base.yaw_rad);
  for (const WallHit& hit : memory.hits) {
    const Eigen::Vector2d in_cells = map_from_base * hit.point / resolution_m;
    const Eigen::Vector2d normal = turn * hit.normal;
    const Eigen::Vector2d step = turn * hit.point.normalized() / kStepsPerCell;
    Eigen::Vector2d position = in_cells - kReachCells * kStepsPerCell * step;
    Cell last = CellOf(position - kStepsPerCell * step, kOneCell);
    for (int i = 0; i <= 2 * kReachCells * kStepsPerCell; ++i, position += step) {
      const Cell cell = CellOf(position, kOneCell);
      if (cell == last) continue;
      last = cell;
      const double behind_cells = (CellCentre(cell, kOneCell) - in_cells).dot(normal);
      memory.distances.push_back({cell, static_cast<float>(resolution_m * behind_cells)});
    }
  }
  return memory.distances;
}

WallDistances::WallDistances(double resolution_m, double free_prob, double wall_prob)
    : free_prob_(free_prob), wall_prob_(wall_prob) {
  geometry_.resolution_m = resolution_m;
}

void WallDistances::GrowToContain(const std::vector<WallDistance>& distances) {
  Cell low = distances.front().cell;
  Cell high = low;
  for (const WallDistance& distance : distances) {
    low = {std::min(low.x, distance.cell.x), std::min(low.y, distance.cell.y)};
    high = {std::max(high.x, distance.cell.x), std::max(high.y, distance.cell.y)};
  }
  if (geometry_.Contains(low) && geometry_.Contains(high)) return;
  GridGeometry needed = geometry_;
  needed.min_cell = {low.x - kGrowthCells, low.y - kGrowthCells};
  needed.width_cells = high.x - low.x + 1 + 2 * kGrowthCells;
  needed.height_cells = high.y - low.y + 1 + 2 * kGrowthCells;
  const GridGeometry grown = Union(geometry_, needed);
  std::vector<float> sum_m(grown.size()), count(grown.size());
  for (std::size_t i = 0; i < count_.size(); ++i) {
    const std::size_t to = grown.Index(geometry_.CellAt(i));
    sum_m[to] = sum_m_[i];
    count[to] = count_[i];
  }
  sum_m_ = std::move(sum_m);
  count_ = std::move(count);
  geometry_ = grown;
}

void WallDistances::Insert(const std::vector<WallDistance>& distances) {
  if (distances.empty()) return;
  GrowToContain(distances);
  for (const WallDistance& distance : distances) {
    const std::size_t index = geometry_.Index(distance.cell);
    sum_m_[index] += distance.behind_m;
    count_[index] += 1.0F;
  }
}

void WallDistances::DrawOver(const OccupancyMap& map, OccupancyMap& drawn) const {
  drawn.geometry = Union(map.geometry, geometry_);
  drawn.occupied_prob.assign(drawn.geometry.size(), kUnknownProb);
  Cell row = map.geometry.min_cell;  // its first cell
  for (int y = 0; y < map.geometry.height_cells; ++y, ++row.y) {
    std::copy_n(&map.occupied_prob[map.geometry.Index(row)], map.geometry.width_cells,
                &drawn.occupied_prob[drawn.geometry.Index(row)]);
  }
  const auto free_prob = static_cast<float>(free_prob_);
  const auto height = static_cast<float>(wall_prob_ - free_prob_);
  const auto per_m = static_cast<float>(1.0 / (kFreeFromCells * geometry_.resolution_m));
  row = geometry_.min_cell;
  for (int y = 0; y < geometry_.height_cells; ++y, ++row.y) {
    const float* const sum_m = &sum_m_[geometry_.Index(row)];
    const float* const count = &count_[geometry_.Index(row)];
    float* const prob = &drawn.occupied_prob[drawn.geometry.Index(row)];
    for (int x = 0; x < geometry_.width_cells; ++x) {  // branch-free, so that it vectorises
      const float distance = per_m * sum_m[x] / std::max(count[x], 1.0F);
      const float near_wall = free_prob + height * std::max(0.0F, 1.0F - distance * distance);
      prob[x] = count[x] > 0.0F ? near_wall : prob[x];
    }
  }
}

}  // namespace depthgrid
