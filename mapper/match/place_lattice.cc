#include "mapper/match/place_lattice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

constexpr double kCoarseStepM = 0.1;
// The lattice uses the map's cells, or blocks of them if they are smaller than this or if the map
// with all that returns can reach would need more than half a gigabyte.
constexpr double kCoarseCellM = 0.05;
constexpr std::size_t kMostCoarseCells = std::size_t{1} << 26;
// Search margin around the map: a camera does not see the place where it stands.
constexpr double kMarginM = 2.0;
constexpr int kHeadings = 90;            // 4 degrees apart: 0.2 m at 3 m, within the score's width
constexpr std::size_t kBestPlaces = 60;  // number of places that are refined

// The score of a return that ends in a cell and of one that passes through it. The grid has a
// margin of unseen cells, so that it contains the returns of every candidate.
class CoarseMap {
 public:
  CoarseMap(const GridGeometry& geometry, const DistanceField& walls) : geometry_(geometry) {
    cells_.reserve(geometry_.size());
    for (std::size_t i = 0; i < geometry_.size(); ++i) {
      const Eigen::Vector2d centre = CellCentre(geometry_.CellAt(i), geometry_.resolution_m);
      const double d = walls.At(centre) / kCoarseSigmaM;
      const double free = kFreeWorth / static_cast<double>(std::size(kOnTheWay));
      cells_.push_back({static_cast<float>(std::exp(-0.5 * d * d)),
                        static_cast<float>(free * walls.FreeAt(centre))});
    }
  }

  // Index offsets of a return's four cells from the candidate's cell.
  struct Offsets {
    std::ptrdiff_t end = 0;
    std::ptrdiff_t on_the_way[std::size(kOnTheWay)] = {};
  };
  std::vector<Offsets> OffsetsAt(const PlaceReturns& points, double heading_rad,
                                 double reach_m) const {
    const Eigen::Rotation2Dd turn(heading_rad);
    const auto offset_of = [&](const Eigen::Vector2d& point) {
      // Shortened to reach_m: beyond that, points are outside the map for every candidate.
      const double share = std::min(1.0, reach_m / std::max(point.norm(), 1e-9));
      // Relative to a cell's centre.
      const Cell cell = CellOf((turn * (share * point)).array() + 0.5 * geometry_.resolution_m,
                               geometry_.resolution_m);
      return static_cast<std::ptrdiff_t>(cell.y) * geometry_.width_cells + cell.x;
    };
    std::vector<Offsets> offsets;
    for (const PlaceReturn& point : points) {
      Offsets& offset = offsets.emplace_back();
      offset.end = offset_of(point.to);
      for (std::size_t i = 0; i < std::size(kOnTheWay); ++i) {
        offset.on_the_way[i] = offset_of(point.from + kOnTheWay[i] * (point.to - point.from));
      }
    }
    return offsets;
  }

  // The score, 0..1; stops with a value below `least` as soon as `least` cannot be reached.
  double ScoreAt(const Cell& cell, const std::vector<Offsets>& offsets, double least) const {
    const CellWorth* here = cells_.data() + geometry_.Index(cell);
    const auto most = static_cast<float>(1.0 + kFreeWorth);
    const auto count = static_cast<float>(offsets.size());
    // The loss still allowed, with a margin for rounding.
    float spare = (1.0F - static_cast<float>(least)) * most * count + 1e-3F;
    float sum = 0.0F;
    for (const Offsets& offset : offsets) {
      float worth = here[offset.end].as_end;
      for (const std::ptrdiff_t way : offset.on_the_way) worth += here[way].on_the_way;
      sum += worth;
      spare -= most - worth;
      if (spare < 0.0F) return 0.0;
    }
    return sum / (most * count);
  }

 private:
  struct CellWorth {
    float as_end = 0.0F;
    float on_the_way = 0.0F;
  };
  GridGeometry geometry_;
  std::vector<CellWorth> cells_;
};

// The largest distance of a point or sensor from the first scan's base.
double ReachOf(const PlaceReturns& points) {
  double reach_m = 0.0;
  for (const PlaceReturn& point : points) {
    reach_m = std::max({reach_m, point.from.norm(), point.to.norm()});
  }
  return reach_m;
}

// The geometry with squares of `side` x `side` cells as cells, covering all of `fine`.
GridGeometry Coarser(const GridGeometry& fine, int side) {
  const auto down = [&](int cell) {
    return static_cast<int>(std::floor(static_cast<double>(cell) / side));
  };
  const Cell first{down(fine.min_cell.x), down(fine.min_cell.y)};
  return {side * fine.resolution_m, first,
          down(fine.min_cell.x + fine.width_cells - 1) - first.x + 1,
          down(fine.min_cell.y + fine.height_cells - 1) - first.y + 1};
}

// The searched cells and the margin that returns can reach from there.
struct CoarseGeometry {
  GridGeometry map;
  int margin_cells = 0;
  GridGeometry reached;
};

CoarseGeometry GeometryOf(const GridGeometry& fine, double reach_m) {
  const auto least = static_cast<int>(std::ceil(kCoarseCellM / fine.resolution_m - 1e-6));
  for (int side = std::max(1, least);; side *= 2) {
    CoarseGeometry coarse;
    coarse.map = Coarser(fine, side);
    const double cell_m = coarse.map.resolution_m;
    coarse.margin_cells = static_cast<int>(std::lround(kMarginM / cell_m));
    const int reach = static_cast<int>(std::ceil(reach_m / cell_m)) + 2;
    coarse.reached = Widened(coarse.map, coarse.margin_cells + reach);
    if (coarse.reached.size() <= kMostCoarseCells) return coarse;
  }
}

}  // namespace

std::vector<PlaceCandidate> BestOnLattice(const OccupancyMap& map, const DistanceField& walls,
                                          const PlaceReturns& points) {
  std::vector<PlaceCandidate> best;
  const auto better = [](const PlaceCandidate& a, const PlaceCandidate& b) {
    return a.score > b.score;
  };
  const GridGeometry& fine = map.geometry;
  const double across_m =
      fine.resolution_m * std::hypot(fine.width_cells, fine.height_cells) + 2.0 * kMarginM;
  const double reach_m = std::min(ReachOf(points), across_m);
  const auto [g, margin, reached] = GeometryOf(fine, reach_m);
  const int step = std::max(1, static_cast<int>(std::lround(kCoarseStepM / g.resolution_m)));
  const CoarseMap coarse(reached, walls);
  for (int heading = 0; heading < kHeadings; ++heading) {
    const double heading_rad = WrapAngle(2.0 * kPi * heading / kHeadings);
    const auto offsets = coarse.OffsetsAt(points, heading_rad, reach_m);
    for (int y = -margin; y < g.height_cells + margin; y += step) {
      for (int x = -margin; x < g.width_cells + margin; x += step) {
        const Cell cell{g.min_cell.x + x, g.min_cell.y + y};
        // The robot's own cell may be unknown, but not occupied.
        if (walls.FreeAt(CellCentre(cell, g.resolution_m)) < 0) continue;
        const double least = best.size() == kBestPlaces ? best.front().score : 0.0;
        const double score = coarse.ScoreAt(cell, offsets, least);
        if (best.size() == kBestPlaces && score <= least) continue;
        // A heap with the worst of the best places in front.
        if (best.size() == kBestPlaces) {
          std::pop_heap(best.begin(), best.end(), better);
          best.pop_back();
        }
        const Eigen::Vector2d centre = CellCentre(cell, g.resolution_m);
        best.push_back({{centre.x(), centre.y(), heading_rad}, score});
        std::push_heap(best.begin(), best.end(), better);
      }
    }
  }
  return best;
}

}  // namespace depthgrid
