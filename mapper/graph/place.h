// A place: what the scans around a frame saw together, in that frame's base axes.
#pragma once

#include <vector>

#include "mapper/core/mapped_frame.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/options.h"

namespace depthgrid {

struct PlaceOptions {
  // Frames belong to the place of the frame in their middle when the way to them is this short.
  // With a narrow view it takes a few metres of them to tell one place from another.
  double reach_m = 1.5;
  double turn_deg = 120.0;
  int max_scans = 16;  // of them, evenly spread
  double resolution_m = 0.05;

  void Visit(OptionsVisitor& v);
};

// A place is told by what is near: what is seen farther off, in halls and outdoors, would only make
// its grids large.
constexpr double kPlaceSightM = 80.0;
// What a scan shows within it.
Scan WithinSight(Scan scan);

// Where the mapped frame of this position is, map from base.
inline const Pose2& PoseAt(const std::vector<MappedFrame>& frames, int i) {
  return FrameAt(frames, i).map_from_base;
}

// Positions among the mapped frames, in order of time. Frames whose scan was not kept do not count.
std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const PlaceOptions& options);
// Only those from `begin` to before `end`.
std::vector<int> FramesAround(const std::vector<MappedFrame>& frames, int middle,
                              const PlaceOptions& options, int begin, int end);

// The map that these scans draw.
OccupancyMap DrawPlace(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                       int middle, double resolution_m);

// Where they hit, one point a cell.
std::vector<Eigen::Vector2d> PointsOfPlace(const std::vector<MappedFrame>& frames,
                                           const std::vector<int>& members, int middle,
                                           double resolution_m);

}  // namespace depthgrid
