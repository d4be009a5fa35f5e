// A place: what the scans around a frame saw together, in that frame's base axes.
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/options.h"

namespace depthgrid {

struct PlaceOptions {
  // Frames belong to a place up to this path length and turn from its middle frame. With a narrow
  // view a few metres are needed to distinguish places.
  double reach_m = 1.5;
  double turn_deg = 120.0;
  int max_scans = 16;  // most scans used, evenly spread
  double resolution_m = 0.05;

  void Visit(OptionsVisitor& v);
};

// Range limit for places: farther returns, in halls and outdoors, would only make the grids large.
constexpr double kPlaceSightM = 80.0;
// The same in cells: with cells below 5 cm, the limit is less than 80 m. A grid of 3,200 cells a
// side and what is computed from it take 0.12 GB; at 1 cm, 80 m would take 25 times as much.
constexpr double kPlaceSightCells = 1600.0;
// The scan limited to both, for a grid of these cells.
Scan WithinSight(Scan scan, double resolution_m);

// map_from_base of the mapped frame at index i.
inline const Pose2& PoseAt(const std::vector<MappedFrame>& frames, int i) {
  return FrameAt(frames, i).map_from_base;
}

// Path length to each frame.
std::vector<double> WaysTo(const std::vector<MappedFrame>& frames);

// At most `most` of the positions (2 or more), evenly spread, with the first and the last.
std::vector<int> EvenlySpread(const std::vector<int>& positions, int most);

// Indices of the mapped frames of a place, in order of time; only those whose scans are stored.
std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const PlaceOptions& options);
// Only those in [begin, end).
std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const PlaceOptions& options, int begin, int end);

// The map drawn from the members' scans.
OccupancyMap DrawPlace(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                       int middle, double resolution_m);

// The members' hits, one point per cell.
std::vector<Eigen::Vector2d> PointsOfPlace(const std::vector<MappedFrame>& frames,
                                           const std::vector<int>& members, int middle,
                                           double resolution_m);

}  // namespace depthgrid
