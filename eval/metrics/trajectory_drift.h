// Drift of an estimate: the error of relative motion over given times and path lengths.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "eval/metrics/association.h"

namespace depthgrid {

struct Drift {
  double over = 0.0;  // seconds, or metres of the reference's path
  int motions = 0;
  double translation_rms_m = 0.0;
  double rotation_rms_rad = 0.0;
  double translation_mean_m = 0.0;
  // Mean of what the motions actually span: up to one step between poses more than `over`.
  double mean_over = 0.0;

  // Drift per second or per metre.
  double PerUnit() const { return translation_mean_m / mean_over; }
};

// Times and lengths at which drift is measured. At 10 s and 1 m drift dominates over the jitter of
// single poses.
constexpr std::array<double, 5> kDriftLagsS = {0.1, 1.0, 3.0, 10.0, 30.0};
constexpr std::array<double, 4> kDriftLengthsM = {1.0, 2.0, 5.0, 10.0};

// From every pose to the first that is at least `lag_s` later; not counted if it is more than 1.5
// lag_s later. Empty when no motion is long enough.
std::optional<Drift> DriftOverTime(const std::vector<PosePair>& pairs, double lag_s);
// Length of the reference's path from the first pair to each, metres, in xyz.
std::vector<double> ReferencePath(const std::vector<PosePair>& pairs);
// From every pose to the first at least `length_m` of the reference's path ahead (KITTI's rule,
// Geiger et al. 2012, with every pose a start).
std::optional<Drift> DriftOverPath(const std::vector<PosePair>& pairs, double length_m);

}  // namespace depthgrid
