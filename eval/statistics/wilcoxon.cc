#include "eval/statistics/wilcoxon.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "eval/statistics/distributions.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Doubled ranks of the differences' sizes, in the order given; mean ranks of ties may be halves, so
// these are integers. Also the tie correction: the sum of t^3 - t over groups of t ties.
struct Ranks {
  std::vector<int> doubled;
  double tie_sum = 0.0;
};
Ranks RanksOf(const PairedDifferences& differences) {
  std::vector<std::size_t> order(differences.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto size_at = [&](std::size_t i) { return std::abs(differences.values[i]); };
  const auto are_tied = [&](std::size_t smaller, std::size_t larger) {
    return size_at(larger) - size_at(smaller) <=
           std::max(differences.rounding[smaller], differences.rounding[larger]);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return size_at(a) < size_at(b); });
  Ranks ranks;
  ranks.doubled.resize(order.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && are_tied(order[first], order[end])) ++end;
    // Twice the mean of the ranks first + 1 .. end.
    for (std::size_t i = first; i < end; ++i) {
      ranks.doubled[order[i]] = static_cast<int>(first + 1 + end);
    }
    const auto tied = static_cast<double>(end - first);
    ranks.tie_sum += tied * tied * tied - tied;
    first = end;
  }
  return ranks;
}

// The share of all sign patterns whose doubled W+ is at most `limit`. The distribution is computed
// by adding one rank after the other.
double ShareUpTo(const std::vector<int>& doubled_ranks, int limit) {
  const int total = std::accumulate(doubled_ranks.begin(), doubled_ranks.end(), 0);
  std::vector<double> share(static_cast<std::size_t>(total) + 1, 0.0);
  share[0] = 1.0;
  int reached = 0;
  for (const int rank : doubled_ranks) {
    reached += rank;
    for (int sum = reached; sum >= 0; --sum) {
      const auto at = static_cast<std::size_t>(sum);
      const double with = sum >= rank ? share[static_cast<std::size_t>(sum - rank)] : 0.0;
      share[at] = 0.5 * (share[at] + with);
    }
  }
  return std::accumulate(share.begin(), share.begin() + limit + 1, 0.0);
}

double NormalPValue(int n, double statistic, double tie_sum) {
  const double mean = 0.25 * n * (n + 1.0);
  const double variance = (n * (n + 1.0) * (2.0 * n + 1.0) - 0.5 * tie_sum) / 24.0;
  return 2.0 * NormalCdf(-std::abs(statistic - mean) / std::sqrt(variance));
}

WilcoxonResult Test(const PairedDifferences& differences, WilcoxonMethod method) {
  PairedDifferences ranked;
  for (std::size_t i = 0; i < differences.values.size(); ++i) {
    Require(std::isfinite(differences.values[i]), "differences are finite");
    if (differences.values[i] == 0.0) continue;
    ranked.values.push_back(differences.values[i]);
    ranked.rounding.push_back(differences.rounding[i]);
  }
  WilcoxonResult result;
  result.pairs = static_cast<int>(ranked.values.size());
  result.zeros = static_cast<int>(differences.values.size() - ranked.values.size());
  if (ranked.values.empty()) return result;
  const Ranks ranks = RanksOf(ranked);
  // A double, because from 46,341 pairs on the sums exceed an int.
  double plus = 0.0;
  for (std::size_t i = 0; i < ranked.values.size(); ++i) {
    plus += ranked.values[i] > 0.0 ? ranks.doubled[i] : 0;
  }
  const double total = static_cast<double>(result.pairs) * (result.pairs + 1);
  const double smaller = std::min(plus, total - plus);
  result.statistic = 0.5 * smaller;
  result.rank_biserial = (2.0 * plus - total) / total;
  result.exact = method == WilcoxonMethod::kExact ||
                 (method == WilcoxonMethod::kAuto && result.pairs <= kWilcoxonExactPairs);
  result.p_value = result.exact
                       ? std::min(1.0, 2.0 * ShareUpTo(ranks.doubled, static_cast<int>(smaller)))
                       : NormalPValue(result.pairs, result.statistic, ranks.tie_sum);
  return result;
}

}  // namespace

double LeastWilcoxonP(int pairs) { return std::min(1.0, std::ldexp(2.0, -pairs)); }

WilcoxonResult Wilcoxon(const std::vector<double>& differences, WilcoxonMethod method) {
  return Test({differences, std::vector<double>(differences.size(), 0.0)}, method);
}

WilcoxonResult WilcoxonOfPairs(const PairedDifferences& differences) {
  return Test(differences, WilcoxonMethod::kAuto);
}

}  // namespace depthgrid
