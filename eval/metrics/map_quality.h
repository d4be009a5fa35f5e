// Map scores beyond the cell scores (docs/metrics.md, "Maps").
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

// The expensive ones can be switched off.
struct MetricsOptions {
  bool registration = true;
  bool ssim = true;
  bool navigation = true;
  NavigabilityOptions navigability;

  void Visit(OptionsVisitor& v);
};

struct MapQuality {
  WallDistanceScore walls;                      // without registration
  std::optional<MapRegistration> registration;  // empty: no walls, or switched off
  std::optional<WallDistanceScore> registered;  // with the walls moved by `registration`
  std::optional<WallThickness> thickness;
  std::optional<WallThickness> true_thickness;
  std::optional<double> double_wall_rate;
  std::optional<Calibration> calibration;
  std::optional<double> ssim;
  TruthlessScore truthless;
  TruthlessScore truthless_of_truth;  // that of a perfect map
  std::optional<Navigability> navigability;
};

// Whether the registration's motion moves the walls farther from the true ones, both by chamfer
// distance and by F1 at 5 cm: then the motion is not an error of the map.
bool FitsBetterAsItLies(const MapQuality& quality);

// Over the observable cells or, without an observable set, those whose truth is known. All three
// must have the same resolution. `own_walls`: if the estimate was resampled to the truth's grid,
// its walls before that.
MapQuality ScoreMapQuality(const StateMap& truth, const OccupancyMap& estimate,
                           const std::optional<CellSet>& observable, const MetricsOptions& options,
                           const std::optional<PlacedWalls>& own_walls = std::nullopt);

}  // namespace depthgrid
