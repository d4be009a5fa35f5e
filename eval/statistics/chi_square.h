// Whether errors are as large as their covariances say: e^T C^-1 e of each is a chi-square value.
#pragma once

#include <optional>
#include <vector>

namespace depthgrid {

// P(X <= value) for a chi-square variable; good to 1e-7.
double ChiSquareCdf(double value, double degrees);
// The value with that probability, in (0, 1).
double ChiSquareQuantile(double probability, double degrees);

struct ChiSquareSample {
  double value = 0.0;
  int degrees = 0;
};

// Of many such values, a degree of freedom: 1 is expected, more is over-confident.
struct Consistency {
  int count = 0;
  double mean = 0.0;
  // Within these the mean lies with 95 % if the values are independent and the covariances right.
  double low = 0.0;
  double high = 0.0;
  double share_within_95 = 0.0;  // of the values, below their own 95 % quantile
};

// Samples without degrees are left out; empty when none are left.
std::optional<Consistency> ConsistencyOf(const std::vector<ChiSquareSample>& samples);

}  // namespace depthgrid
