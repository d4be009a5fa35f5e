// Summary of a metric over the seeds of one grid point of a sweep.
#pragma once

#include <optional>
#include <vector>

#include "eval/statistics/resamples.h"

namespace depthgrid {

struct SampleSummary {
  int count = 0;
  double mean = 0.0;
  double median = 0.0;
  double std = 0.0;  // of the sample (divided by n - 1); 0 for one value
  double min = 0.0;
  double max = 0.0;
  std::optional<ConfidenceInterval> mean_interval;  // bootstrap; empty for one value
};

// Finite values, at least one, as many as Resamples::size().
SampleSummary SummariseSample(const std::vector<double>& values, const Resamples& resamples);

}  // namespace depthgrid
