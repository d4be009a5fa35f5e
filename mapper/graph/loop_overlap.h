// Tests a loop by overlaying the scans of its two places: a true loop puts walls on walls, a false
// one walls into free space.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/grid_geometry.h"
#include "mapper/core/options.h"
#include "mapper/core/reference_map.h"

namespace depthgrid {

struct OverlapOptions {
  // The place of a frame consists of every `stride`-th scan up to this many frames away.
  int window_frames = 20;
  int stride = 5;
  double resolution_m = 0.05;
  // A point this near to a wall agrees: errors of loops are 2 cm and 0.6 degrees (6 cm at 6 m).
  double tolerance_m = 0.1;
  // Least number of points of one place in cells that the other one saw; with fewer there is no
  // result.
  int min_points = 100;
  // Least share of those that lies on walls.
  double min_agreement = 0.7;

  void Visit(OptionsVisitor& v);
};

struct Overlap {
  int compared = 0;
  int agreeing = 0;
  double agreement() const {
    return compared == 0 ? 0.0 : static_cast<double>(agreeing) / compared;
  }
};

// The same, each way.
struct OverlapEachWay {
  Overlap of_first;   // points of the first place in what the second one saw
  Overlap of_second;  // and the other way round
  Overlap both() const {
    return {of_first.compared + of_second.compared, of_first.agreeing + of_second.agreeing};
  }
};

// What a place's scans saw, in base axes of its middle frame.
struct SeenPlace {
  enum Finding : std::uint8_t { kUnseen, kFree, kWall };
  std::vector<Eigen::Vector2d> points;  // obstacles
  GridGeometry geometry;
  std::vector<Finding> findings;  // per cell; kWall: a wall is within the tolerance
};

// The frames before `end` that make up the place of frame `middle`, without those elsewhere, as
// after a jump of SLAM.
std::vector<int> FramesOfPlace(const std::vector<MappedFrame>& frames, int middle,
                               const OverlapOptions& options, int end);
SeenPlace SeenFrom(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                   int middle, const OverlapOptions& options);
// Points in what a place's scans saw.
Overlap PointsIn(const SeenPlace& place, const std::vector<Eigen::Vector2d>& points,
                 const Pose2& place_from_points);
OverlapEachWay EachWay(const SeenPlace& first, const SeenPlace& second,
                       const Pose2& first_from_second);
inline Overlap OverlapOf(const SeenPlace& first, const SeenPlace& second,
                         const Pose2& first_from_second) {
  return EachWay(first, second, first_from_second).both();
}

// SeenPlace of all members, of the even ones and of the odd ones.
struct SeenInHalves {
  SeenPlace all, even, odd;
};
SeenInHalves SeenInHalvesFrom(const std::vector<MappedFrame>& frames,
                              const std::vector<int>& members, int middle,
                              const OverlapOptions& options);

// A frame's obstacles within the places' range limit, in its base axes.
std::vector<Eigen::Vector2d> PointsSeenBy(const MappedFrame& frame, const OverlapOptions& options);

// In both directions: points of the second place in the grid of the first and vice versa. Places
// are drawn with the current poses, which are accurate over a second or two.
Overlap OverlapOf(const std::vector<MappedFrame>& frames, const PlanarLoop& loop,
                  const OverlapOptions& options);

// The same with given members of the places.
Overlap OverlapOf(const std::vector<MappedFrame>& frames, const std::vector<int>& first_members,
                  const std::vector<int>& second_members, const PlanarLoop& loop,
                  const OverlapOptions& options);

// Agreement of a place with itself: its even scans against its odd ones. Below 1 with noisy ranges
// or moving people; an upper limit for a true loop.
Overlap OverlapWithItself(const SeenInHalves& place);

bool Agrees(const Overlap& overlap, const OverlapOptions& options);

}  // namespace depthgrid
