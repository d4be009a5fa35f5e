#include "eval/metrics/map_quality.h"

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/ssim.h"

namespace depthgrid {

void MetricsOptions::Visit(OptionsVisitor& v) {
  v.Flag("registration", registration, "scores after laying the map over the true one");
  v.Flag("ssim", ssim, "structural similarity");
  v.Flag("navigation", navigation, "plans on the map, judged in the true one");
  v.Group("navigability", navigability, "the robot and its plans");
}

namespace {

// The true map knows a wall to its cell alone (one on a boundary is in the cell above it,
// docs/truth.md), and half of a good map's cells may lie beside it. A motion that leaves the walls
// no nearer to each other than they are is not told by the map, nor is one that brings true walls
// nearer of which the map has none.
std::optional<MapRegistration> RegistrationOf(const ScoredMaps& maps, const CellSet& true_walls,
                                              const PlacedWalls& placed) {
  auto found = RegisterWalls(maps.truth, placed, maps.scored);
  if (!found) return {};
  const auto distances = [&](const Pose2& motion) {
    return DistancesToWallLines(true_walls, placed.walls, maps.scored,
                                motion * placed.truth_from_cells);
  };
  const auto as_it_lies = distances({});
  const auto moved = distances(found->truth_from_estimate);
  const auto both_m = [](const LineDistances& d) {
    return d.estimate_to_truth_m + d.truth_to_estimate_m;
  };
  // Of walls on the lattice's lines some motion fits which cells lie on which side: a room with
  // true poses came 0.09 cells nearer by 0.7 degrees.
  constexpr double kLeastGainCells = 0.1;
  const double least_gain_m = kLeastGainCells * maps.truth.geometry.resolution_m;
  if (!as_it_lies) return found;
  const bool nearer = moved &&
                      moved->estimate_to_truth_m + least_gain_m < as_it_lies->estimate_to_truth_m &&
                      both_m(*moved) < both_m(*as_it_lies);
  return nearer ? found : MapRegistration{};
}

}  // namespace

MapQuality ScoreMapQuality(const StateMap& truth, const OccupancyMap& estimate,
                           const std::optional<CellSet>& observable, const MetricsOptions& options,
                           const std::optional<PlacedWalls>& own_walls) {
  const ScoredMaps maps = OnOneGeometry(truth, StatesOf(estimate), observable);
  const CellSet true_walls = CellsIn(maps.truth, CellState::kOccupied);
  const CellSet walls = CellsIn(maps.estimate, CellState::kOccupied);
  const PlacedWalls placed = own_walls.value_or(PlacedWalls{walls, {}});
  const auto moved_by = [&](const Pose2& motion) {
    return ScoreWallDistances(true_walls, placed.walls, maps.scored,
                              motion * placed.truth_from_cells);
  };
  MapQuality quality;
  quality.walls = moved_by({});
  if (options.registration) quality.registration = RegistrationOf(maps, true_walls, placed);
  if (quality.registration) {
    quality.registered = moved_by(quality.registration->truth_from_estimate);
  }
  quality.thickness = ThicknessOf(walls, maps.scored);
  quality.true_thickness = ThicknessOf(true_walls, maps.scored);
  quality.double_wall_rate = DoubleWallRate(true_walls, walls, maps.scored);
  quality.calibration = Calibrate(maps.truth, estimate, maps.scored);
  if (options.ssim) quality.ssim = Ssim(maps.truth, maps.estimate, maps.scored);
  quality.truthless = ScoreWithoutTruth(maps.estimate);
  quality.truthless_of_truth = ScoreWithoutTruth(maps.truth);
  if (options.navigation) {
    quality.navigability = Navigate(maps.truth, maps.estimate, maps.scored, options.navigability);
  }
  return quality;
}

}  // namespace depthgrid
