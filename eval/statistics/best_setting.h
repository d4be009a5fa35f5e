// Finds the best value of a swept setting, such as the Kalman gain, and its uncertainty. There is
// none for Better::kNeither, which is a broken precondition.
#pragma once

#include <cstddef>
#include <vector>

#include "eval/statistics/paired_comparison.h"

namespace depthgrid {

// A metric at one value of the setting, by seed. All settings have the same seeds in the same
// order.
struct SettingRuns {
  double setting = 0.0;
  std::vector<double> by_seed;
};

struct BestSetting {
  std::size_t index = 0;  // of the best mean; the first on ties
  double setting = 0.0;
  bool is_alike = false;  // all settings give the same for every seed: none is the best
  // Bootstrap interval of the best setting; its ends are swept values.
  ConfidenceInterval setting_interval;
  std::vector<double> share_best;   // by setting: share of the resamples in which it is the best;
                                    // settings that tie divide a resample among them
  std::vector<double> p_as_good;    // by setting: p-value of Wilcoxon's test against the best,
                                    // Holm-adjusted; 1 for the best
  std::vector<double> regret_mean;  // by setting: mean over seeds of Regret() against the best
};

// At least one setting and one seed.
BestSetting FindBestSetting(const std::vector<SettingRuns>& runs, Better better,
                            const Resamples& resamples);

// The best value of all settings for each seed: what an oracle would reach that chooses one setting
// per run. An oracle that chooses one per frame is a run of its own (fusion.mode `oracle`).
std::vector<double> BestOfEachSeed(const std::vector<SettingRuns>& runs, Better better);

// By how much a setting is worse than an oracle, per seed; never negative if the oracle is never
// worse.
std::vector<double> Regret(const std::vector<double>& by_seed,
                           const std::vector<double>& oracle_by_seed, Better better);

}  // namespace depthgrid
