#include "mapper/graph/loop_overlap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/occupancy_map.h"
#include "mapper/graph/place.h"
#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"

namespace depthgrid {
namespace {

// Frames farther apart are not of one place; within window_frames nobody gets so far, except at low
// frame rates.
constexpr double kPlaceReachM = 10.0;

GridOptions PlaceGrid(const OverlapOptions& options) {
  GridOptions grid;
  grid.resolution_m = options.resolution_m;
  return grid;
}

void RaiseRow(const SeenPlace::Finding* findings, std::size_t count, SeenPlace::Finding* into) {
  for (std::size_t i = 0; i < count; ++i) {
    into[i] =
        std::max(into[i], findings[i] == SeenPlace::kWall ? SeenPlace::kWall : SeenPlace::kUnseen);
  }
}

// Dilates walls by reach_cells, along rows and then along columns, so that looking up one cell
// suffices.
void RaiseAroundWalls(int reach_cells, SeenPlace& place) {
  if (place.findings.empty()) return;
  const auto width = static_cast<std::size_t>(place.geometry.width_cells);
  const auto height = static_cast<std::size_t>(place.geometry.height_cells);
  for (std::size_t step = 1; step <= 2; ++step) {
    const std::size_t stride = step == 1 ? 1 : width;
    const std::vector<SeenPlace::Finding> before = place.findings;
    for (std::size_t away = stride; away <= static_cast<std::size_t>(reach_cells) * stride;
         away += stride) {
      const std::size_t count = width * height - away;
      RaiseRow(before.data(), count, place.findings.data() + away);
      RaiseRow(before.data() + away, count, place.findings.data());
    }
  }
}

// The margin is so wide that dilation stays inside.
void SetFindings(const OccupancyMap& map, int reach_cells, SeenPlace& place) {
  place.geometry = Widened(map.geometry, reach_cells);
  place.findings.assign(place.geometry.size(), SeenPlace::kUnseen);
  const float* prob = map.occupied_prob.data();
  for (int y = 0; y < map.geometry.height_cells; ++y) {
    const Cell first{map.geometry.min_cell.x, map.geometry.min_cell.y + y};
    SeenPlace::Finding* const row = &place.findings[place.geometry.Index(first)];
    for (int x = 0; x < map.geometry.width_cells; ++x, ++prob) {
      const SeenPlace::Finding free = *prob == *prob ? SeenPlace::kFree : SeenPlace::kUnseen;
      row[x] = *prob > 0.5F ? SeenPlace::kWall : free;
    }
  }
  RaiseAroundWalls(reach_cells, place);
}

struct ScanInPlace {
  Scan scan;
  Pose2 middle_from_base;
};

ScanInPlace ScanOf(const std::vector<MappedFrame>& frames, int member, int middle,
                   double resolution_m) {
  const MappedFrame& frame = frames[static_cast<std::size_t>(member)];
  const Pose2 middle_from_map = Inverse(frames[static_cast<std::size_t>(middle)].map_from_base);
  return {WithinSight(*frame.scan, resolution_m), middle_from_map * frame.map_from_base};
}

std::vector<Eigen::Vector2d> HitsOf(const Scan& scan, const Pose2& middle_from_base) {
  std::vector<Eigen::Vector2d> hits;
  for (const Beam& beam : scan.beams) {
    if (beam.hit) hits.emplace_back(middle_from_base * EndPoint(beam));
  }
  return hits;
}

// Accumulates a SeenPlace scan by scan.
class SeenSoFar {
 public:
  explicit SeenSoFar(const OverlapOptions& options)
      : reach_cells_(static_cast<int>(std::lround(options.tolerance_m / options.resolution_m))),
        grid_(PlaceGrid(options)) {}
  void Add(const ScanCells& cells, const std::vector<Eigen::Vector2d>& hits) {
    grid_.Insert(cells);
    place_.points.insert(place_.points.end(), hits.begin(), hits.end());
  }
  SeenPlace Place() {
    SetFindings(grid_.map(), reach_cells_, place_);
    return std::move(place_);
  }

 private:
  int reach_cells_;
  ProbabilityGrid grid_;
  SeenPlace place_;
};

}  // namespace

void OverlapOptions::Visit(OptionsVisitor& v) {
  v.Number("window_frames", window_frames, {0, 1000},
           "a frame's place is what the frames up to this many before and after it saw");
  v.Number("stride", stride, {1, 1000}, "only every so many of them are used");
  v.Number("resolution_m", resolution_m, {0.01, 1.0}, "cell size of the places' grids, metres");
  v.Number("tolerance_m", tolerance_m, {0.0, 1.0}, "a point this near to a wall agrees, metres");
  v.Number("min_points", min_points, {1, 1e9}, "points that both places saw, at least");
  v.Number("min_agreement", min_agreement, {0.0, 1.0},
           "share of these points that must lie on walls");
}

std::vector<int> FramesOfPlace(const std::vector<MappedFrame>& frames, int middle,
                               const OverlapOptions& options, int end) {
  std::vector<int> members;
  const int steps = options.window_frames / options.stride;
  for (int step = -steps; step <= steps; ++step) {
    const int index = middle + step * options.stride;
    if (index < 0 || index >= end) continue;
    const MappedFrame& frame = frames[static_cast<std::size_t>(index)];
    const Pose2 apart =
        Between(frames[static_cast<std::size_t>(middle)].map_from_base, frame.map_from_base);
    if (frame.scan && apart.translation().norm() < kPlaceReachM) members.push_back(index);
  }
  return members;
}

SeenPlace SeenFrom(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                   int middle, const OverlapOptions& options) {
  SeenSoFar seen(options);
  ScanRasterizer rasterizer;
  for (const int member : members) {
    const auto [scan, middle_from_base] = ScanOf(frames, member, middle, options.resolution_m);
    seen.Add(rasterizer.Rasterize(scan, middle_from_base, options.resolution_m),
             HitsOf(scan, middle_from_base));
  }
  return seen.Place();
}

SeenInHalves SeenInHalvesFrom(const std::vector<MappedFrame>& frames,
                              const std::vector<int>& members, int middle,
                              const OverlapOptions& options) {
  SeenSoFar all(options), even(options), odd(options);
  ScanRasterizer rasterizer;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto [scan, middle_from_base] = ScanOf(frames, members[i], middle, options.resolution_m);
    const auto& cells = rasterizer.Rasterize(scan, middle_from_base, options.resolution_m);
    const std::vector<Eigen::Vector2d> hits = HitsOf(scan, middle_from_base);
    all.Add(cells, hits);
    (i % 2 == 0 ? even : odd).Add(cells, hits);
  }
  return {all.Place(), even.Place(), odd.Place()};
}

Overlap PointsIn(const SeenPlace& place, const std::vector<Eigen::Vector2d>& points,
                 const Pose2& place_from_points) {
  Overlap overlap;
  for (const Eigen::Vector2d& point : points) {
    const Cell cell = CellOf(place_from_points * point, place.geometry.resolution_m);
    if (!place.geometry.Contains(cell)) continue;
    const SeenPlace::Finding finding = place.findings[place.geometry.Index(cell)];
    overlap.compared += finding == SeenPlace::kUnseen ? 0 : 1;
    overlap.agreeing += finding == SeenPlace::kWall ? 1 : 0;
  }
  return overlap;
}

std::vector<Eigen::Vector2d> PointsSeenBy(const MappedFrame& frame, const OverlapOptions& options) {
  return HitsOf(WithinSight(*frame.scan, options.resolution_m), Pose2{});
}

OverlapEachWay EachWay(const SeenPlace& first, const SeenPlace& second,
                       const Pose2& first_from_second) {
  return {PointsIn(second, first.points, Inverse(first_from_second)),
          PointsIn(first, second.points, first_from_second)};
}

Overlap OverlapOf(const std::vector<MappedFrame>& frames, const PlanarLoop& loop,
                  const OverlapOptions& options) {
  const int end = static_cast<int>(frames.size());
  return OverlapOf(frames, FramesOfPlace(frames, loop.first, options, end),
                   FramesOfPlace(frames, loop.second, options, end), loop, options);
}

Overlap OverlapOf(const std::vector<MappedFrame>& frames, const std::vector<int>& first_members,
                  const std::vector<int>& second_members, const PlanarLoop& loop,
                  const OverlapOptions& options) {
  return OverlapOf(SeenFrom(frames, first_members, loop.first, options),
                   SeenFrom(frames, second_members, loop.second, options), loop.first_from_second);
}

Overlap OverlapWithItself(const SeenInHalves& place) {
  return OverlapOf(place.even, place.odd, Pose2{});
}

bool Agrees(const Overlap& overlap, const OverlapOptions& options) {
  return overlap.compared >= options.min_points && overlap.agreement() >= options.min_agreement;
}

}  // namespace depthgrid
