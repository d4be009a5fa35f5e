#include "mapper/graph/place.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mapper/grid/probability_grid.h"
#include "mapper/grid/scan_rasterizer.h"

namespace depthgrid {
namespace {

// The last frame on one side (step -1 or 1) within reach and within [begin, end).
int FarthestFrame(const std::vector<MappedFrame>& frames, int middle, int step,
                  const PlaceOptions& options, int begin, int end) {
  double way_m = 0.0;
  double turn_rad = 0.0;
  int i = middle;
  while (i + step >= begin && i + step < end) {
    const Pose2 motion = Between(PoseAt(frames, i), PoseAt(frames, i + step));
    way_m += motion.translation().norm();
    turn_rad += std::abs(motion.yaw_rad);
    if (way_m > options.reach_m || turn_rad > RadFromDeg(options.turn_deg)) break;
    i += step;
  }
  return i;
}

}  // namespace

void PlaceOptions::Visit(OptionsVisitor& v) {
  v.Number("reach_m", reach_m, {0.0, 100.0},
           "distance travelled to a place's outermost frames, metres");
  v.Number("turn_deg", turn_deg, {0.0, 1e4}, "turning over that distance, at most");
  v.Number("max_scans", max_scans, {1, 1000}, "scans of a place, at most, evenly spread");
  v.Number("resolution_m", resolution_m, {0.01, 1.0},
           "size of the cells that are searched, metres");
}

Scan WithinSight(Scan scan, double resolution_m) {
  const auto sight_m = static_cast<float>(std::min(kPlaceSightM, kPlaceSightCells * resolution_m));
  for (Beam& beam : scan.beams) {
    beam.hit = beam.hit && beam.range_m <= sight_m;
    beam.clear_to_m = std::min(beam.clear_to_m, sight_m);
  }
  return scan;
}

std::vector<double> WaysTo(const std::vector<MappedFrame>& frames) {
  std::vector<double> way_m(frames.size(), 0.0);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const Pose2 step = Between(frames[i - 1].map_from_base, frames[i].map_from_base);
    way_m[i] = way_m[i - 1] + step.translation().norm();
  }
  return way_m;
}

std::vector<int> EvenlySpread(const std::vector<int>& positions, int most) {
  const int all = static_cast<int>(positions.size());
  if (all <= most) return positions;
  std::vector<int> spread;
  for (int k = 0; k < most; ++k) {
    spread.push_back(positions[static_cast<std::size_t>((all - 1) * k / (most - 1))]);
  }
  return spread;
}

std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const PlaceOptions& options) {
  return FramesAround(frames, middle, options, 0, static_cast<int>(frames.size()));
}

std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const PlaceOptions& options, int begin, int end) {
  const int first = FarthestFrame(frames, middle, -1, options, begin, end);
  const int last = FarthestFrame(frames, middle, 1, options, begin, end);
  std::vector<int> with_scan;
  for (int i = first; i <= last; ++i) {
    if (frames[static_cast<std::size_t>(i)].scan) with_scan.push_back(i);
  }
  if (std::min(options.max_scans, static_cast<int>(with_scan.size())) == 1) {
    return {frames[static_cast<std::size_t>(middle)].scan ? middle : with_scan[0]};
  }
  return EvenlySpread(with_scan, options.max_scans);
}

OccupancyMap DrawPlace(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                       int middle, double resolution_m) {
  ScanRasterizer rasterizer;
  GridOptions grid_options;
  grid_options.resolution_m = resolution_m;
  ProbabilityGrid grid(grid_options);
  const Pose2 middle_from_map = Inverse(PoseAt(frames, middle));
  for (const int i : members) {
    const MappedFrame& frame = frames[static_cast<std::size_t>(i)];
    grid.Insert(rasterizer.Rasterize(WithinSight(*frame.scan, resolution_m),
                                     middle_from_map * frame.map_from_base, resolution_m));
  }
  return grid.map();
}

std::vector<Eigen::Vector2d> PointsOfPlace(const std::vector<MappedFrame>& frames,
                                           const std::vector<int>& members, int middle,
                                           double resolution_m) {
  std::vector<Eigen::Vector2d> hits;
  std::vector<Cell> cells;
  const Pose2 middle_from_map = Inverse(PoseAt(frames, middle));
  for (const int i : members) {
    const MappedFrame& frame = frames[static_cast<std::size_t>(i)];
    const Pose2 middle_from_base = middle_from_map * frame.map_from_base;
    const Scan scan = WithinSight(*frame.scan, resolution_m);
    for (const Beam& beam : scan.beams) {
      if (!beam.hit) continue;
      hits.emplace_back(middle_from_base * EndPoint(beam));
      cells.push_back(CellOf(hits.back(), resolution_m));
    }
  }
  // The first hit of each cell, so that near walls do not outweigh far ones; row by row.
  constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  const GridGeometry geometry = BoundsOf(cells, resolution_m);
  std::vector<std::uint32_t> first(geometry.size(), kNone);
  for (std::size_t i = cells.size(); i-- > 0;) {
    first[geometry.Index(cells[i])] = static_cast<std::uint32_t>(i);
  }
  std::vector<Eigen::Vector2d> points;
  for (const std::uint32_t i : first) {
    if (i != kNone) points.push_back(hits[i]);
  }
  return points;
}

}  // namespace depthgrid
