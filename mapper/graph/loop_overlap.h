// Does what two places saw agree when a loop lays them over each other? A false loop puts walls
// into rooms; a true one puts walls on walls.
#pragma once

#include <vector>

#include "mapper/core/options.h"
#include "mapper/reference_map.h"

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
Overlap OverlapWithItself(const std::vector<MappedFrame>& frames, int frame,
                          const OverlapOptions& options);

bool Agrees(const Overlap& overlap, const OverlapOptions& options);

}  // namespace depthgrid
