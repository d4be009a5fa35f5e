// The one home of log-odds: l = ln(p / (1 - p)), so that Bayes' rule for independent observations
// is a sum (Moravec and Elfes 1985; docs/math.md, "Log-odds update").
#pragma once

#include <cmath>

namespace depthgrid {

inline double LogOdds(double prob) { return std::log(prob / (1.0 - prob)); }
inline double ProbabilityFromLogOdds(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

// Grids store whole thousandths: a sum of integers does not depend on the order of its terms, and
// the step rounds hit and miss by less than 0.03 % of a hit.
constexpr double kLogOddsUnit = 1e-3;

inline int LogOddsUnits(double prob) {
  return static_cast<int>(std::lround(LogOdds(prob) / kLogOddsUnit));
}

}  // namespace depthgrid
