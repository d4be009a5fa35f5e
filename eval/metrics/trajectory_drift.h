// How fast an estimate drifts: the error of relative motion against the time and the path it is
// taken over.
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
  // What the motions are really over, mean: longer than `over` by up to one step between poses.
  double mean_over = 0.0;

  // Drift a second, or a metre.
  double PerUnit() const { return translation_mean_m / mean_over; }
};

// The times and lengths drift is told for; 10 s and 1 m are where relative motion errs by drift and
// no longer by the jitter of single poses.
constexpr std::array<double, 5> kDriftLagsS = {0.1, 1.0, 3.0, 10.0, 30.0};
constexpr std::array<double, 4> kDriftLengthsM = {1.0, 2.0, 5.0, 10.0};

// From every pose to the first that is at least `lag_s` later; its own lag may be longer by up to
// half of it, else it does not count. Empty when no motion is long enough.
std::optional<Drift> DriftOverTime(const std::vector<PosePair>& pairs, double lag_s);
// The reference's path from the first pair to each, metres; xyz.
std::vector<double> ReferencePath(const std::vector<PosePair>& pairs);
// From every pose to the first at least `length_m` of the reference's path ahead (KITTI's rule,
// Geiger et al. 2012, with every pose a start).
std::optional<Drift> DriftOverPath(const std::vector<PosePair>& pairs, double length_m);

}  // namespace depthgrid
