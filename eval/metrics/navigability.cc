#include "eval/metrics/navigability.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/distance_transform.h"
#include "eval/metrics/grid_paths.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// Free cells whose centre is at least `clearance_m` from every wall cell's centre.
CellSet Passable(const StateMap& map, double clearance_m) {
  const std::vector<double> squared_cells = SquaredDistances(CellsIn(map, CellState::kOccupied));
  const double least_cells = std::max(0.0, clearance_m - kCentreSlackM) / map.geometry.resolution_m;
  CellSet passable(map.geometry);
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    passable.members[i] =
        map.states[i] == CellState::kFree && squared_cells[i] >= least_cells * least_cells;
  }
  return passable;
}

struct Errand {
  Cell start;
  std::vector<Cell> goals;
};

// Random starts, each with random goals that are far enough away; whether paths exist is checked
// later. Starts without such a goal are drawn again, a limited number of times.
std::vector<Errand> DrawErrands(const CellSet& passable, const CellSet& allowed,
                                const NavigabilityOptions& options) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < passable.members.size(); ++i) {
    const Cell cell = passable.geometry.CellAt(i);
    if (passable.members[i] != 0 && allowed.Has(cell)) cells.push_back(cell);
  }
  std::vector<Errand> errands;
  if (cells.empty()) return errands;
  constexpr int kTriesPerDraw = 20;
  RandomStream random(options.seed, RandomStage::kNavigability);
  const auto draw = [&] { return cells[random.Below(cells.size())]; };
  const double least_cells = options.least_distance_m / passable.geometry.resolution_m;
  for (int tries = 0;
       static_cast<int>(errands.size()) < options.starts && tries < options.starts * kTriesPerDraw;
       ++tries) {
    Errand errand{draw(), {}};
    for (int i = 0; i < options.goals_per_start * kTriesPerDraw &&
                    static_cast<int>(errand.goals.size()) < options.goals_per_start;
         ++i) {
      const Cell goal = draw();
      const double apart_cells = std::hypot(goal.x - errand.start.x, goal.y - errand.start.y);
      // A cell is no goal of itself.
      if (apart_cells >= std::max(1.0, least_cells)) errand.goals.push_back(goal);
    }
    if (!errand.goals.empty()) errands.push_back(std::move(errand));
  }
  return errands;
}

// The cells that the centre of the robot may be in.
struct PassableCells {
  CellSet of_truth;       // with the planner's margin, in the true map
  CellSet of_estimate;    // the same in the estimated map
  CellSet not_colliding;  // without the margin, in the true map
};

bool Collides(const std::vector<Cell>& path, const CellSet& not_colliding) {
  for (const Cell& cell : path) {
    if (!not_colliding.Has(cell)) return true;
  }
  return false;
}

struct PlanTally {
  Navigability result;
  double length_ratios = 0.0;
};

void Run(const Errand& errand, const PassableCells& passable, PlanTally& tally) {
  const GridPaths true_ways(passable.of_truth, errand.start, errand.goals);
  const GridPaths ways(passable.of_estimate, errand.start, errand.goals);
  for (const Cell& goal : errand.goals) {
    const auto true_length = true_ways.LengthCells(goal);
    if (!true_length) continue;
    ++tally.result.pairs;
    const auto length = ways.LengthCells(goal);
    if (!length) continue;
    ++tally.result.planned;
    tally.length_ratios += *length / *true_length;
    tally.result.collisions += Collides(ways.PathTo(goal), passable.not_colliding) ? 1 : 0;
  }
}

}  // namespace

void NavigabilityOptions::Visit(OptionsVisitor& v) {
  v.Number("robot_radius_m", robot_radius_m, {0.0, 10.0},
           "radius of the robot that plans are made for");
  v.Number("margin_m", margin_m, {0.0, 10.0},
           "distance that the planner keeps from walls beyond the radius");
  v.Number("starts", starts, {1, 10000}, "places from which plans are made");
  v.Number("goals_per_start", goals_per_start, {1, 10000}, "plans made from each of them");
  v.Number("least_distance_m", least_distance_m, {0.0, 1e4},
           "distance between start and goal, at least");
  v.Seed("seed", seed, "seed of the choice of starts and goals");
}

std::optional<Navigability> Navigate(const StateMap& truth, const StateMap& estimate,
                                     const CellSet& allowed, const NavigabilityOptions& options) {
  const double keep_m = options.robot_radius_m + options.margin_m;
  const PassableCells passable = {.of_truth = Passable(truth, keep_m),
                                  .of_estimate = Passable(estimate, keep_m),
                                  .not_colliding = Passable(truth, options.robot_radius_m)};
  PlanTally tally;
  for (const Errand& errand : DrawErrands(passable.of_truth, allowed, options)) {
    Run(errand, passable, tally);
  }
  Navigability& result = tally.result;
  if (result.pairs == 0) return std::nullopt;
  const double pairs = result.pairs;
  result.success_rate = (result.planned - result.collisions) / pairs;
  result.falsely_blocked_rate = (result.pairs - result.planned) / pairs;
  result.collision_rate = Ratio(result.collisions, result.planned);
  result.length_ratio = Ratio(tally.length_ratios, result.planned);
  return result;
}

}  // namespace depthgrid
