#include "eval/statistics/paired_comparison.h"

#include <cmath>

#include "eval/metrics/statistics.h"
#include "eval/statistics/sample_summary.h"
#include "mapper/core/error.h"

namespace depthgrid {

PairedComparison ComparePaired(const std::vector<double>& a, const std::vector<double>& b,
                               Better better, const Resamples& resamples) {
  Require(!a.empty(), "at least one pair is compared");
  const PairedDifferences differences = DifferencesOf(a, b);
  PairedComparison result;
  for (const double difference : differences.values) {
    if (better == Better::kNeither) continue;
    const double b_is_worse = better == Better::kLower ? difference : -difference;
    result.a_wins += b_is_worse > 0.0 ? 1 : 0;
    result.b_wins += b_is_worse < 0.0 ? 1 : 0;
  }
  const SampleSummary summary = SummariseSample(differences.values, resamples);
  result.pairs = summary.count;
  result.mean_a = Summarise(a).mean;
  result.mean_b = Summarise(b).mean;
  const double rounding = Summarise(differences.rounding).mean;
  result.mean_difference = std::abs(summary.mean) <= rounding ? 0.0 : summary.mean;
  result.median_difference = summary.median;
  result.std_difference = summary.std;
  result.mean_interval = summary.mean_interval;
  result.wilcoxon = WilcoxonOfPairs(differences);
  return result;
}

}  // namespace depthgrid
