// Whether a robot can drive by the map: plans made on the estimated map, judged in the true one.
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
  // The planner keeps this much more from walls than the robot needs, m: a cell.
  double margin_m = 0.05;
  int starts = 8;
  int goals_per_start = 5;
  double least_distance_m = 1.0;  // between start and goal, as the crow flies
  std::uint64_t seed = 1;         // of the starts and goals

  void Visit(OptionsVisitor& v);
};

struct Navigability {
  int pairs = 0;    // starts and goals between which the true map has a way
  int planned = 0;  // of these, those with a way on the estimated map
  // Of the planned, those that would hit a true wall, or leave what is truly free.
  int collisions = 0;
  double success_rate = 0.0;             // planned and no collision, of all pairs
  double falsely_blocked_rate = 0.0;     // not planned, of all pairs
  std::optional<double> collision_rate;  // of the planned
  std::optional<double> length_ratio;    // mean over the planned: way on the estimate / true way
};

// Starts and goals are cells from which the robot with its margin is clear in truth, among
// `allowed` (what could be seen). A planner drives over free cells only, its centre at least radius
// and margin from any wall's centre; the judge asks for the radius alone and allows truly free
// cells only. Empty when the truth offers no pair. All on one geometry.
std::optional<Navigability> Navigate(const StateMap& truth, const StateMap& estimate,
                                     const CellSet& allowed, const NavigabilityOptions& options);

}  // namespace depthgrid
