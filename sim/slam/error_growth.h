// How errors grow with time, and which jitter, walk and bias make them grow so.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

// The summed error since a stretch began.
struct SummedError {
  double stamp_s = 0.0;
  Eigen::Vector3d error;
};
// A stretch without gaps, one entry a frame.
using ErrorTrack = std::vector<SummedError>;

// Mean square per axis of the error over a lag.
struct Growth {
  double lag_s = 0.0;
  double mean_square = 0.0;
  double weight = 0.0;  // independent stretches of that lag, at most 100
};

// At lags of 1, 2, 3, 5, 8 ... frames up to a third of the longest track, those without any error
// left out. A lag lasts the mean time of its pairs: stamps jitter, and a walk's growth is linear in
// time. `axes` of the three are in use, the others 0.
std::vector<Growth> MeasureGrowth(const std::vector<ErrorTrack>& tracks, int axes);

// One sigma each, per axis: white and slowly varying error of a pose, random walk in 1 s, slowly
// varying rate.
struct GrowthTerms {
  double jitter = 0.0;
  double bias = 0.0;
  double walk = 0.0;
  double drift = 0.0;
  double misfit = 0.0;  // weighted mean square of the relative differences
};

struct CorrelationTimes {
  double bias_s = 1.0;
  double drift_s = 10.0;
};

// 2 jitter^2 + 2 bias^2 (1 - exp(-t/b)) + walk^2 t + 2 drift^2 d^2 (t/d - 1 + exp(-t/d)).
double GrowthOf(const GrowthTerms& terms, const CorrelationTimes& times, double lag_s);

// The terms, none negative, nearest to the growth in relative least squares, beside a walk of known
// square. None, and no misfit, where nothing grew.
GrowthTerms FitGrowth(const std::vector<Growth>& growth, const CorrelationTimes& times,
                      double known_walk_square);

}  // namespace depthgrid
