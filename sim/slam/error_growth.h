// Growth of pose errors over time lags, and a fit of jitter, bias, walk and drift to it.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

// The accumulated error since the start of a track.
struct SummedError {
  double stamp_s = 0.0;
  Eigen::Vector3d error;
};
// A track without gaps, one entry per frame.
using ErrorTrack = std::vector<SummedError>;

// Mean square of the error over a time lag, per axis.
struct Growth {
  double lag_s = 0.0;
  double mean_square = 0.0;
  double weight = 0.0;  // number of independent intervals of that lag, at most 100
};

// At lags of 1, 2, 3, 5, 8 ... frames up to a third of the longest track; lags without any error
// are omitted. `lag_s` is the mean time of the lag's pairs, as stamps jitter and a walk's growth is
// linear in time. `axes` of the three components are used, the others are 0.
std::vector<Growth> MeasureGrowth(const std::vector<ErrorTrack>& tracks, int axes);

// Standard deviations per axis: white error of the pose (jitter), slowly varying error of the pose
// (bias), random walk in 1 s, slowly varying rate (drift).
struct GrowthTerms {
  double jitter = 0.0;
  double bias = 0.0;
  double walk = 0.0;
  double drift = 0.0;
  double misfit = 0.0;  // weighted mean square of the relative residuals
};

struct CorrelationTimes {
  double bias_s = 1.0;
  double drift_s = 10.0;
};

// 2 jitter^2 + 2 bias^2 (1 - exp(-t/b)) + walk^2 t + 2 drift^2 d^2 (t/d - 1 + exp(-t/d)).
double GrowthOf(const GrowthTerms& terms, const CorrelationTimes& times, double lag_s);

// Fits non-negative terms to the growth by relative least squares, in addition to a walk of known
// square. All zero, misfit included, without growth.
GrowthTerms FitGrowth(const std::vector<Growth>& growth, const CorrelationTimes& times,
                      double known_walk_square);

}  // namespace depthgrid
