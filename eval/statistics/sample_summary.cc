#include "eval/statistics/sample_summary.h"

#include <cmath>

#include "eval/metrics/statistics.h"

namespace depthgrid {

SampleSummary SummariseSample(const std::vector<double>& values, const Resamples& resamples) {
  const Statistics s = Summarise(values);
  SampleSummary summary;
  summary.count = s.count;
  summary.mean = s.mean;
  summary.median = s.median;
  if (s.count > 1) summary.std = s.std * std::sqrt(s.count / (s.count - 1.0));
  summary.min = s.min;
  summary.max = s.max;
  summary.mean_interval = MeanInterval(values, resamples);
  return summary;
}

}  // namespace depthgrid
