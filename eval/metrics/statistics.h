// Summary statistics of a list of errors.
#pragma once

#include <vector>

namespace depthgrid {

struct Statistics {
  int count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  // mean of the middle two for an even count
  double std = 0.0;     // of the population (divided by n), as NumPy and evo have it
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  // sum of squared errors
};

// At least one value.
Statistics Summarise(const std::vector<double>& values);

// NumPy's default percentile (linear between order statistics); `fraction` in [0, 1], at least one
// value.
double Percentile(std::vector<double> values, double fraction);

}  // namespace depthgrid
