#include "eval/statistics/paired_comparison.h"

#include "eval/metrics/statistics.h"
#include "eval/statistics/sample_summary.h"
#include "mapper/core/error.h"

namespace depthgrid {

PairedComparison ComparePaired(const std::vector<double>& a, const std::vector<double>& b,
                               Better better, const Resamples& resamples) {
  Require(a.size() == b.size() && !a.empty(), "pairs are of as many values on both sides");
  std::vector<double> differences;
  PairedComparison result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differences.push_back(b[i] - a[i]);
    if (better == Better::kNeither) continue;
    const double b_is_worse = better == Better::kLower ? differences[i] : -differences[i];
    result.a_wins += b_is_worse > 0.0 ? 1 : 0;
    result.b_wins += b_is_worse < 0.0 ? 1 : 0;
  }
  const SampleSummary summary = SummariseSample(differences, resamples);
  result.pairs = summary.count;
  result.mean_a = Summarise(a).mean;
  result.mean_b = Summarise(b).mean;
  result.mean_difference = summary.mean;
  result.median_difference = summary.median;
  result.std_difference = summary.std;
  result.mean_interval = summary.mean_interval;
  result.wilcoxon = Wilcoxon(differences);
  return result;
}

}  // namespace depthgrid
