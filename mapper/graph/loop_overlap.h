// Does what two places saw agree when a loop lays them over each other? A false loop puts walls
// into rooms; a true one puts walls on walls.
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/grid_geometry.h"
#include "mapper/core/options.h"
#include "mapper/core/reference_map.h"

namespace depthgrid {

struct OverlapOptions {
  // Scans around a frame that stand for its place: up to this many frames away, every `stride`-th.
  int window_frames = 20;
  int stride = 5;
  double resolution_m = 0.05;
  // A point this near to a wall agrees: loops err by 2 cm and 0.6 degrees (6 cm at 6 m).
  double tolerance_m = 0.1;
  // Points of one place that the other one saw, as walls or as free; with fewer nothing is known.
  int min_points = 100;
  // Of those, the share that must lie on walls.
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

// What a place saw, in base axes of the frame in its middle.
struct SeenPlace {
  enum Finding : std::uint8_t { kUnseen, kFree, kWall };
  std::vector<Eigen::Vector2d> points;  // obstacles
  GridGeometry geometry;
  std::vector<Finding> findings;  // of each cell: a wall is within the tolerance, or else free
};

// The frames whose scans stand for the place of one of them, as if there were none from `end` on.
// Those that lie elsewhere do not, as where SLAM jumped.
std::vector<int> FramesOfPlace(const std::vector<MappedFrame>& frames, int middle,
                               const OverlapOptions& options, int end);
SeenPlace SeenFrom(const std::vector<MappedFrame>& frames, const std::vector<int>& members,
                   int middle, const OverlapOptions& options);
Overlap OverlapOf(const SeenPlace& first, const SeenPlace& second, const Pose2& first_from_second);

// The same of all members, of every other of them and of those between.
struct SeenInHalves {
  SeenPlace all, even, odd;
};
SeenInHalves SeenInHalvesFrom(const std::vector<MappedFrame>& frames,
                              const std::vector<int>& members, int middle,
                              const OverlapOptions& options);

// Both ways: points of the second place in the grid of the first and the other way round. Places
// are drawn from the frames' current poses, which are good over a second or two.
Overlap OverlapOf(const std::vector<MappedFrame>& frames, const PlanarLoop& loop,
                  const OverlapOptions& options);

// The same with these frames for the places.
Overlap OverlapOf(const std::vector<MappedFrame>& frames, const std::vector<int>& first_members,
                  const std::vector<int>& second_members, const PlanarLoop& loop,
                  const OverlapOptions& options);

// What a place agrees with itself by: every other of its scans against those between. Less than 1
// where ranges are noisy or people walk, and a true loop cannot agree by more.
Overlap OverlapWithItself(const SeenInHalves& place);

bool Agrees(const Overlap& overlap, const OverlapOptions& options);

}  // namespace depthgrid
