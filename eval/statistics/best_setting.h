// Which value of a swept setting is best, such as the Kalman gain, and how sure that is.
#pragma once

#include <cstddef>
#include <vector>

#include "eval/statistics/paired_comparison.h"

namespace depthgrid {

// A metric at one value of the setting, by seed; every setting has the same seeds in one order.
struct SettingRuns {
  double setting = 0.0;
  std::vector<double> by_seed;
};

struct BestSetting {
  std::size_t index = 0;  // the best mean; the first on ties
  double setting = 0.0;
  // Of the best setting over resampled seeds: swept values, never between them.
  ConfidenceInterval setting_interval;
  std::vector<double> share_best;  // by setting: of the resamples, those in which it is the best
  std::vector<double> p_as_good;   // by setting: Wilcoxon against the best, Holm-adjusted; 1 for it
  std::vector<double> regret_mean;  // by setting: mean over seeds of what is lost to the best one
};

// At least one setting and one seed.
BestSetting FindBestSetting(const std::vector<SettingRuns>& runs, Better better,
                            const Resamples& resamples);

// The best of all settings for each seed: what an oracle would reach that chooses one setting a
// run. An oracle that chooses one a frame is a run of its own (fusion.mode `oracle`).
std::vector<double> BestOfEachSeed(const std::vector<SettingRuns>& runs, Better better);

// What a setting loses to an oracle, seed by seed: not negative if the oracle is never worse.
std::vector<double> Regret(const std::vector<double>& by_seed,
                           const std::vector<double>& oracle_by_seed, Better better);

}  // namespace depthgrid
