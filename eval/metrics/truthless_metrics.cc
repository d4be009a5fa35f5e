#include "eval/metrics/truthless_metrics.h"

#include <algorithm>
#include <array>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/picture_filter.h"

namespace depthgrid {
namespace {

constexpr int kApartPx = 2;  // radius within which only the strongest response counts

// Central difference along x (dx = 1) or y (dy = 1); zero at the edge.
Picture Slope(const Picture& picture, int dx, int dy) {
  Picture slope = picture;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const bool inside = x > 0 && y > 0 && x + 1 < picture.width && y + 1 < picture.height;
      slope.At(x, y) =
          inside ? 0.5 * (picture.At(x + dx, y + dy) - picture.At(x - dx, y - dy)) : 0.0;
    }
  }
  return slope;
}

// Harris and Stephens 1988, of the picture of walls: positive where walls end, meet or bend,
// negative along them.
Picture CornerResponse(const StateMap& map) {
  constexpr double kHarrisK = 0.04;
  const Picture walls =
      Smoothed(PictureOfStates(map, {0.0, 0.0, 1.0}, kWindowRadiusPx + kApartPx), 1.0, 3);
  const Picture dx = Slope(walls, 1, 0);
  const Picture dy = Slope(walls, 0, 1);
  const Picture xx = Smoothed(Product(dx, dx), kWindowSigmaPx, kWindowRadiusPx);
  const Picture xy = Smoothed(Product(dx, dy), kWindowSigmaPx, kWindowRadiusPx);
  const Picture yy = Smoothed(Product(dy, dy), kWindowSigmaPx, kWindowRadiusPx);
  Picture response = xx;
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    const double trace = xx.values[i] + yy.values[i];
    response.values[i] =
        xx.values[i] * yy.values[i] - xy.values[i] * xy.values[i] - kHarrisK * trace * trace;
  }
  return response;
}

// Of equal responses the first in row order counts.
bool IsStrongest(const Picture& response, int x, int y) {
  const double here = response.At(x, y);
  for (int j = -kApartPx; j <= kApartPx; ++j) {
    for (int i = -kApartPx; i <= kApartPx; ++i) {
      const double there = response.At(x + i, y + j);
      const bool earlier = j < 0 || (j == 0 && i < 0);
      if (there > here || (there == here && earlier)) return false;
    }
  }
  return true;
}

int CountCorners(const StateMap& map) {
  // Responses of walls one cell thick along the axes: 2.4e-5 at an end, 5.3e-5 at a bend, 7.6e-5 at
  // a junction. Steps of slanted walls and single cells are below zero.
  constexpr double kLeastResponse = 2e-5;
  const Picture response = CornerResponse(map);
  int corners = 0;
  for (int y = kApartPx; y + kApartPx < response.height; ++y) {
    for (int x = kApartPx; x + kApartPx < response.width; ++x) {
      if (response.At(x, y) < kLeastResponse) continue;
      corners += IsStrongest(response, x, y) ? 1 : 0;
    }
  }
  return corners;
}

// Marks all cells connected to `start` without crossing walls; returns whether they reach the
// border.
bool FloodReachesBorder(const StateMap& map, std::size_t start, std::vector<std::uint8_t>& seen) {
  constexpr std::array<Cell, 4> kNeighbours = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const GridGeometry& g = map.geometry;
  bool reaches_border = false;
  std::vector<std::size_t> open = {start};
  seen[start] = 1;
  while (!open.empty()) {
    const Cell cell = g.CellAt(open.back());
    open.pop_back();
    for (const Cell& step : kNeighbours) {
      const Cell next{cell.x + step.x, cell.y + step.y};
      reaches_border = reaches_border || !g.Contains(next);
      if (map.At(next) == CellState::kOccupied || !g.Contains(next)) continue;
      if (seen[g.Index(next)] != 0) continue;
      seen[g.Index(next)] = 1;
      open.push_back(g.Index(next));
    }
  }
  return reaches_border;
}

int CountEnclosedAreas(const StateMap& map) {
  std::vector<std::uint8_t> seen(map.geometry.size(), 0);
  int enclosed = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != 0 || map.states[i] == CellState::kOccupied) continue;
    enclosed += FloodReachesBorder(map, i, seen) ? 0 : 1;
  }
  return enclosed;
}

}  // namespace

TruthlessScore ScoreWithoutTruth(const StateMap& map) {
  TruthlessScore score;
  const auto cells = [&](CellState state) {
    return static_cast<double>(std::count(map.states.begin(), map.states.end(), state));
  };
  const double occupied = cells(CellState::kOccupied);
  score.occupied_share = Ratio(occupied, occupied + cells(CellState::kFree));
  score.corners = CountCorners(map);
  score.enclosed_areas = CountEnclosedAreas(map);
  return score;
}

}  // namespace depthgrid
