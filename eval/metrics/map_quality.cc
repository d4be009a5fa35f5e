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
// no nearer to each other than they are is not told by the map.
std::optional<MapRegistration> RegistrationOf(const ScoredMaps& maps, const CellSet& true_walls,
                                              const CellSet& walls) {
  auto found = RegisterMap(maps.truth, maps.estimate, maps.scored);
  if (!found) return {};
  const auto as_it_lies_m = DistanceToWallLines(true_walls, walls, maps.scored);
  const auto moved_m =
      DistanceToWallLines(true_walls, walls, maps.scored, found->truth_from_estimate);
  if (as_it_lies_m && (!moved_m || *as_it_lies_m <= *moved_m)) return MapRegistration{};
  return found;
}

}  // namespace

MapQuality ScoreMapQuality(const StateMap& truth, const OccupancyMap& estimate,
                           const std::optional<CellSet>& observable,
                           const MetricsOptions& options) {
  const ScoredMaps maps = OnOneGeometry(truth, StatesOf(estimate), observable);
  const CellSet true_walls = CellsIn(maps.truth, CellState::kOccupied);
  const CellSet walls = CellsIn(maps.estimate, CellState::kOccupied);
  MapQuality quality;
  quality.walls = ScoreWallDistances(true_walls, walls, maps.scored);
  if (options.registration) quality.registration = RegistrationOf(maps, true_walls, walls);
  if (quality.registration) {
    quality.registered = ScoreWallDistances(true_walls, walls, maps.scored,
                                            quality.registration->truth_from_estimate);
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
