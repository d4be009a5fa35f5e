#include "eval/metrics/tum_association.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace depthgrid {

std::vector<PosePair> AssociateAsTum(const Trajectory& reference, const Trajectory& estimate,
                                     double max_difference_s) {
  using Candidate = std::tuple<double, std::size_t, std::size_t>;  // difference, two indices
  std::vector<Candidate> candidates;
  std::size_t first = 0;  // first estimate within the limit; both are sorted
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double stamp_s = reference[i].stamp_s;
    while (first < estimate.size() && estimate[first].stamp_s <= stamp_s - max_difference_s) {
      ++first;
    }
    for (std::size_t j = first;
         j < estimate.size() && estimate[j].stamp_s < stamp_s + max_difference_s; ++j) {
      candidates.emplace_back(std::abs(estimate[j].stamp_s - stamp_s), i, j);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<int> partner(reference.size(), -1);
  std::vector<bool> taken(estimate.size(), false);
  for (const auto& [difference, i, j] : candidates) {
    if (partner[i] >= 0 || taken[j]) continue;
    partner[i] = static_cast<int>(j);
    taken[j] = true;
  }
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (partner[i] < 0) continue;
    pairs.push_back(PairOf(reference[i], estimate[static_cast<std::size_t>(partner[i])]));
  }
  return pairs;
}

}  // namespace depthgrid
