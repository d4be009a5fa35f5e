// A run's path divided into stretches, with the motion of each by SLAM and in the map.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "eval/run/mapping_run.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// Poses jitter by centimetres from frame to frame; over such stretches that does not add up.
constexpr double kStretchM = 0.5;
// A robot may turn on the spot.
constexpr double kStretchRad = 0.5;

// From the first frame of a stretch to its last, in base axes of the first.
struct Stretch {
  Pose2 slam;
  Pose2 map;
  double slam_turn_rad = 0.0;  // summed, including full turns
  double map_turn_rad = 0.0;

  double longer_m() const { return std::max(slam.translation().norm(), map.translation().norm()); }
  double larger_turn_rad() const {
    return std::max(std::abs(slam_turn_rad), std::abs(map_turn_rad));
  }
};

// Consecutive stretches, each ending when `done`. None spans a correction by SLAM, an unannounced
// restart of its poses, a missing pose, or a loss or pause after which the place was guessed.
std::vector<Stretch> StretchesOf(const MappingRun& run,
                                 const std::function<bool(const Stretch&)>& done);

// Stretches of kStretchM or kStretchRad.
std::vector<Stretch> WaysAndTurnsOf(const MappingRun& run);

}  // namespace depthgrid
