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

MapQuality ScoreMapQuality(const StateMap& truth, const OccupancyMap& estimate,
                           const std::optional<CellSet>& observable,
                           const MetricsOptions& options) {
  const ScoredMaps maps = OnOneGeometry(truth, StatesOf(estimate), observable);
  const CellSet true_walls = CellsIn(maps.truth, CellState::kOccupied);
  const CellSet walls = CellsIn(maps.estimate, CellState::kOccupied);
  MapQuality quality;
  quality.walls = ScoreWallDistances(true_walls, walls, maps.scored);
  if (options.registration)
    quality.registration = RegisterMap(maps.truth, maps.estimate, maps.scored);
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
