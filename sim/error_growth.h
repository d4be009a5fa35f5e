// How errors grow with time, and which jitter, walk and bias make them grow so.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

// A stretch without gaps: the summed error since its start, one entry a frame.
using ErrorTrack = std::vector<Eigen::Vector3d>;

// Mean square per axis of the error over a lag.
struct Growth {
  double lag_s = 0.0;
  double mean_square = 0.0;
  double weight = 0.0;  // independent stretches of that lag, at most 100
};

// At lags of 1, 2, 3, 5, 8 ... frames up to a third of the longest track. `axes` of the three are
// in use, the others 0.
std::vector<Growth> MeasureGrowth(const std::vector<ErrorTrack>& tracks, int axes, double frame_s);

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
// square.
GrowthTerms FitGrowth(const std::vector<Growth>& growth, const CorrelationTimes& times,
                      double known_walk_square);

}  // namespace depthgrid
