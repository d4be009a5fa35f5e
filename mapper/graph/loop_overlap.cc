#include "mapper/graph/loop_overlap.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/occupancy_map.h"
#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"

namespace depthgrid {
namespace {

// One place: its scans relative to the frame in its middle, and the map they draw.
struct Place {
  std::vector<Eigen::Vector2d> points;  // obstacles, in the middle frame's base axes
  OccupancyMap map;
};

GridOptions PlaceGrid(const OverlapOptions& options) {
  GridOptions grid;
  grid.resolution_m = options.resolution_m;
  return grid;
}

std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const OverlapOptions& options) {
  std::vector<int> members;
  const int steps = options.window_frames / options.stride;
  for (int step = -steps; step <= steps; ++step) {
    const int index = middle + step * options.stride;
    if (index < 0 || index >= static_cast<int>(frames.size())) continue;
    if (frames[static_cast<std::size_t>(index)].scan) members.push_back(index);
  }
  return members;
}

Place PlaceOf(const std::vector<MappedFrame>& frames, const std::vector<int>& members, int middle,
              const OverlapOptions& options) {
  ScanRasterizer rasterizer;
  ProbabilityGrid grid(PlaceGrid(options));
  Place place;
  const Pose2 middle_from_map = Inverse(frames[static_cast<std::size_t>(middle)].map_from_base);
  for (const int index : members) {
    const MappedFrame& frame = frames[static_cast<std::size_t>(index)];
    const Pose2 middle_from_base = middle_from_map * frame.map_from_base;
    const Scan scan = *frame.scan;
    grid.Insert(rasterizer.Rasterize(scan, middle_from_base, options.resolution_m));
    for (const Beam& beam : scan.beams) {
      if (beam.hit) place.points.push_back(middle_from_base * EndPoint(beam));
    }
  }
  place.map = grid.map();
  return place;
}

enum class Finding { kUnseen, kFree, kWall };

Finding Look(const OccupancyMap& map, const Eigen::Vector2d& point, int reach_cells) {
  const Cell centre = CellOf(point, map.geometry.resolution_m);
  const float here = map.At(centre);
  for (int dy = -reach_cells; dy <= reach_cells; ++dy) {
    for (int dx = -reach_cells; dx <= reach_cells; ++dx) {
      if (map.At({centre.x + dx, centre.y + dy}) > 0.5F) return Finding::kWall;
    }
  }
  return std::isnan(here) ? Finding::kUnseen : Finding::kFree;
}

void Compare(const Place& place, const Place& other, const Pose2& place_from_other,
             const OverlapOptions& options, Overlap& overlap) {
  const int reach_cells = static_cast<int>(std::lround(options.tolerance_m / options.resolution_m));
  for (const Eigen::Vector2d& point : other.points) {
    const Finding finding = Look(place.map, place_from_other * point, reach_cells);
    overlap.compared += finding == Finding::kUnseen ? 0 : 1;
    overlap.agreeing += finding == Finding::kWall ? 1 : 0;
  }
}

}  // namespace

void OverlapOptions::Visit(OptionsVisitor& v) {
  v.Number("window_frames", window_frames, {0, 1000}, "frames around one that stand for its place");
  v.Number("stride", stride, {1, 1000}, "every so many of them");
  v.Number("resolution_m", resolution_m, {0.01, 1.0}, "cells of the places' grids, metres");
  v.Number("tolerance_m", tolerance_m, {0.0, 1.0}, "a point this near to a wall agrees, metres");
  v.Number("min_points", min_points, {1, 1e9}, "points that both saw, at least");
  v.Number("min_agreement", min_agreement, {0.0, 1.0}, "share of them that must lie on walls");
}

Overlap OverlapOf(const std::vector<MappedFrame>& frames, const PlanarLoop& loop,
                  const OverlapOptions& options) {
  return OverlapOf(frames, FramesAround(frames, loop.first, options),
                   FramesAround(frames, loop.second, options), loop, options);
}

Overlap OverlapOf(const std::vector<MappedFrame>& frames, const std::vector<int>& first_members,
                  const std::vector<int>& second_members, const PlanarLoop& loop,
                  const OverlapOptions& options) {
  const Place first = PlaceOf(frames, first_members, loop.first, options);
  const Place second = PlaceOf(frames, second_members, loop.second, options);
  Overlap overlap;
  Compare(first, second, loop.first_from_second, options, overlap);
  Compare(second, first, Inverse(loop.first_from_second), options, overlap);
  return overlap;
}

Overlap OverlapWithItself(const std::vector<MappedFrame>& frames, int frame,
                          const OverlapOptions& options) {
  std::vector<int> even, odd;
  for (const int member : FramesAround(frames, frame, options)) {
    (even.size() > odd.size() ? odd : even).push_back(member);
  }
  PlanarLoop same;
  same.first = same.second = frame;
  return OverlapOf(frames, even, odd, same, options);
}

bool Agrees(const Overlap& overlap, const OverlapOptions& options) {
  return overlap.compared >= options.min_points && overlap.agreement() >= options.min_agreement;
}

}  // namespace depthgrid
