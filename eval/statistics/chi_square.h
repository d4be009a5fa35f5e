// Tests whether errors are consistent with their covariances: e^T C^-1 e of each is a chi-square
// value.
#pragma once

#include <optional>
#include <vector>

namespace depthgrid {

// P(X <= value) for a chi-square variable; accurate to 1e-7.
double ChiSquareCdf(double value, double degrees);
// The inverse of ChiSquareCdf(); probability in (0, 1).
double ChiSquareQuantile(double probability, double degrees);

struct ChiSquareSample {
  double value = 0.0;
  int degrees = 0;
};

// Of many such values, divided by their degrees of freedom: 1 is expected, more means that the
// covariances are too small.
struct Consistency {
  int count = 0;
  double mean = 0.0;
  // 95 % interval of the mean if the values are independent and the covariances correct.
  double low = 0.0;
  double high = 0.0;
  double share_within_95 = 0.0;  // of the values, at most their own 95 % quantile
};

// Samples without degrees are left out; empty when none are left.
std::optional<Consistency> ConsistencyOf(const std::vector<ChiSquareSample>& samples);

}  // namespace depthgrid
