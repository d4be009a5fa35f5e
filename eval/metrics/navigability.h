// Whether a robot can navigate with the map: paths planned on the estimated map, checked in the
// true one.
#pragma once

#include <cstdint>
#include <optional>

#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/options.h"

namespace depthgrid {

struct NavigabilityOptions {
  // A TurtleBot 3 Burger's, m. The room's widest doors are about 0.9 m.
  double robot_radius_m = 0.11;
  // Distance that the planner keeps from walls beyond the robot's radius, m: one cell.
  double margin_m = 0.05;
  int starts = 8;
  int goals_per_start = 5;
  double least_distance_m = 1.0;  // between start and goal, in a straight line
  std::uint64_t seed = 1;         // of the starts and goals

  void Visit(OptionsVisitor& v);
};

struct Navigability {
  int pairs = 0;    // starts and goals joined by a path in the true map
  int planned = 0;  // of these, those with a path on the estimated map
  // Planned paths that would hit a true wall or leave the truly free cells.
  int collisions = 0;
  double success_rate = 0.0;             // planned and no collision, of all pairs
  double falsely_blocked_rate = 0.0;     // not planned, of all pairs
  std::optional<double> collision_rate;  // of the planned
  std::optional<double> length_ratio;    // mean of planned / true path length
};

// Starts and goals are cells of `allowed` (those that could be seen) where the robot with its
// margin is clear of true walls. Planned paths use free cells only, with centres at least radius +
// margin from any wall cell's centre. The check in the true map requires only the radius, and truly
// free cells. Empty when the truth has no such pair. All on one geometry.
std::optional<Navigability> Navigate(const StateMap& truth, const StateMap& estimate,
                                     const CellSet& allowed, const NavigabilityOptions& options);

}  // namespace depthgrid
