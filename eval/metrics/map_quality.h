// What else is said of a map beside cell scores (docs/metrics.md, "Maps").
#pragma once

#include <optional>

#include "eval/metrics/calibration.h"
#include "eval/metrics/map_registration.h"
#include "eval/metrics/navigability.h"
#include "eval/metrics/truthless_metrics.h"
#include "eval/metrics/wall_distances.h"
#include "eval/metrics/wall_shape.h"
#include "mapper/core/options.h"

namespace depthgrid {

// The dear ones can be switched off.
struct MetricsOptions {
  bool registration = true;
  bool ssim = true;
  bool navigation = true;
  NavigabilityOptions navigability;

  void Visit(OptionsVisitor& v);
};

struct MapQuality {
  WallDistanceScore walls;                      // as the map lies
  std::optional<MapRegistration> registration;  // empty: no walls, or switched off
  std::optional<WallDistanceScore> registered;  // the walls moved by it
  std::optional<WallThickness> thickness;
  std::optional<WallThickness> true_thickness;
  std::optional<double> double_wall_rate;
  std::optional<Calibration> calibration;
  std::optional<double> ssim;
  TruthlessScore truthless;
  TruthlessScore truthless_of_truth;  // what a perfect map would get
  std::optional<Navigability> navigability;
};

// Whether walls moved by the registration's motion lie farther from the true ones than as they lie,
// by the chamfer distance and by F1 at 5 cm: then the motion is no error of the map.
bool FitsBetterAsItLies(const MapQuality& quality);

// Over the observable cells, or those whose truth is known when nothing was said about what is
// observable. Same resolution required of all three. `own_walls`: those of an estimate that was
// redrawn on the truth's lattice, as it had them.
MapQuality ScoreMapQuality(const StateMap& truth, const OccupancyMap& estimate,
                           const std::optional<CellSet>& observable, const MetricsOptions& options,
                           const std::optional<PlacedWalls>& own_walls = std::nullopt);

}  // namespace depthgrid
