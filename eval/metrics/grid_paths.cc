#include "eval/metrics/grid_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace depthgrid {
namespace {

struct Step {
  int x;
  int y;
  float length_cells;
};
constexpr float kDiagonal = 1.41421356F;
constexpr std::array<Step, 8> kSteps = {{{1, 0, 1.0F},
                                         {-1, 0, 1.0F},
                                         {0, 1, 1.0F},
                                         {0, -1, 1.0F},
                                         {1, 1, kDiagonal},
                                         {-1, 1, kDiagonal},
                                         {1, -1, kDiagonal},
                                         {-1, -1, kDiagonal}}};

bool CanStep(const CellSet& passable, const Cell& cell, const Step& step) {
  return passable.Has({cell.x + step.x, cell.y + step.y}) &&
         passable.Has({cell.x + step.x, cell.y}) && passable.Has({cell.x, cell.y + step.y});
}

}  // namespace

// Dijkstra's algorithm; of equally distant cells the one with the smaller index is settled first.
GridPaths::GridPaths(const CellSet& passable, const Cell& start,
                     const std::vector<Cell>& stop_after)
    : geometry_(passable.geometry),
      length_cells_(geometry_.size(), std::numeric_limits<float>::infinity()),
      came_by_(geometry_.size(), -1) {
  if (!passable.Has(start)) return;
  std::vector<std::size_t> wanted;
  for (const Cell& cell : stop_after) {
    if (passable.Has(cell)) wanted.push_back(geometry_.Index(cell));
  }
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  length_cells_[geometry_.Index(start)] = 0.0F;
  open.push({0.0F, geometry_.Index(start)});
  while (!open.empty()) {
    const auto [length, index] = open.top();
    open.pop();
    if (length > length_cells_[index]) continue;
    if (std::erase(wanted, index) > 0 && wanted.empty()) return;
    const Cell cell = geometry_.CellAt(index);
    for (std::size_t s = 0; s < kSteps.size(); ++s) {
      if (!CanStep(passable, cell, kSteps[s])) continue;
      const std::size_t next = geometry_.Index({cell.x + kSteps[s].x, cell.y + kSteps[s].y});
      const float next_length = length + kSteps[s].length_cells;
      if (!(next_length < length_cells_[next])) continue;
      length_cells_[next] = next_length;
      came_by_[next] = static_cast<std::int8_t>(s);
      open.push({next_length, next});
    }
  }
}

std::optional<double> GridPaths::LengthCells(const Cell& goal) const {
  if (!geometry_.Contains(goal)) return std::nullopt;
  const float length = length_cells_[geometry_.Index(goal)];
  if (std::isinf(length)) return std::nullopt;
  return length;
}

std::vector<Cell> GridPaths::PathTo(const Cell& goal) const {
  if (!LengthCells(goal)) return {};
  std::vector<Cell> path = {goal};
  for (int by = came_by_[geometry_.Index(goal)]; by >= 0;
       by = came_by_[geometry_.Index(path.back())]) {
    const Step& step = kSteps[static_cast<std::size_t>(by)];
    path.push_back({path.back().x - step.x, path.back().y - step.y});
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace depthgrid
