// The way of a run in stretches, as SLAM and as the map have it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "eval/run/mapping_run.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Poses err by centimetres from frame to frame, which does not add up over such stretches.
constexpr double kStretchM = 0.5;
// A robot may turn on the spot.
constexpr double kStretchRad = 0.5;

// From the first frame of a stretch to its last, in base axes of the first.
struct Stretch {
  Pose2 slam;
  Pose2 map;
  double slam_turn_rad = 0.0;  // added up, whole turns too
  double map_turn_rad = 0.0;

  double longer_m() const { return std::max(slam.translation().norm(), map.translation().norm()); }
  double larger_turn_rad() const {
    return std::max(std::abs(slam_turn_rad), std::abs(map_turn_rad));
  }
};

// Stretches that are `done`, one after the other; none across a correction of SLAM, poses that
// begin anew without a word, or where a pose is missing.
std::vector<Stretch> StretchesOf(const MappingRun& run,
                                 const std::function<bool(const Stretch&)>& done);

// Those that go or turn so far.
std::vector<Stretch> WaysAndTurnsOf(const MappingRun& run);

}  // namespace depthgrid
