#include "eval/statistics/best_setting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/metrics/statistics.h"
#include "eval/statistics/holm.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

void RequireDirection(Better better) {
  Require(better != Better::kNeither, "the best is the least or the greatest");
}

// Smaller is always better.
double Loss(double value, Better better) { return better == Better::kLower ? value : -value; }

// The settings with the best sum, and those whose sums differ from it only by rounding.
std::vector<std::size_t> BestAt(const std::vector<SettingRuns>& runs,
                                std::span<const std::uint32_t> seeds, Better better) {
  std::vector<double> sums;
  for (const SettingRuns& r : runs) {
    double sum = 0.0;
    for (const std::uint32_t seed : seeds) sum += Loss(r.by_seed[seed], better);
    sums.push_back(sum);
  }
  const double least = *std::min_element(sums.begin(), sums.end());
  std::vector<std::size_t> best;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (sums[k] - least <= kRoundingShare * std::abs(least)) best.push_back(k);
  }
  return best;
}

std::size_t BestOfAll(const std::vector<SettingRuns>& runs, Better better) {
  std::vector<std::uint32_t> seeds(runs.front().by_seed.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i] = static_cast<std::uint32_t>(i);
  return BestAt(runs, seeds, better).front();
}

bool AreAlike(const std::vector<SettingRuns>& runs) {
  const std::vector<double>& first = runs.front().by_seed;
  return runs.size() > 1 && std::all_of(runs.begin(), runs.end(), [&](const SettingRuns& r) {
           return std::equal(first.begin(), first.end(), r.by_seed.begin(), [](double a, double b) {
             return std::abs(a - b) <= kRoundingShare * std::abs(a);
           });
         });
}

// Quantiles of the resamples' least and greatest best settings, rounded outwards to members of the
// lists.
ConfidenceInterval IntervalOfMembers(std::vector<double> least, std::vector<double> greatest,
                                     double confidence) {
  std::sort(least.begin(), least.end());
  std::sort(greatest.begin(), greatest.end());
  const auto last = static_cast<double>(least.size() - 1);
  const double low = std::floor(0.5 * (1.0 - confidence) * last);
  const double high = std::ceil(0.5 * (1.0 + confidence) * last);
  return {least[static_cast<std::size_t>(low)], greatest[static_cast<std::size_t>(high)]};
}

std::vector<double> AdjustedAgainst(const std::vector<SettingRuns>& runs, std::size_t best) {
  std::vector<double> p_values;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (k == best) continue;
    const PairedDifferences differences = DifferencesOf(runs[best].by_seed, runs[k].by_seed);
    p_values.push_back(WilcoxonOfPairs(differences).p_value);
  }
  std::vector<double> adjusted = HolmAdjusted(p_values);
  adjusted.insert(adjusted.begin() + static_cast<std::ptrdiff_t>(best), 1.0);
  return adjusted;
}

}  // namespace

BestSetting FindBestSetting(const std::vector<SettingRuns>& runs, Better better,
                            const Resamples& resamples) {
  RequireDirection(better);
  Require(!runs.empty(), "the best is one of at least one setting");
  for (const SettingRuns& r : runs) {
    Require(r.by_seed.size() == resamples.size(), "every setting has the same seeds");
  }
  BestSetting best;
  best.index = BestOfAll(runs, better);
  best.setting = runs[best.index].setting;
  best.is_alike = AreAlike(runs);
  best.share_best.assign(runs.size(), 0.0);
  std::vector<double> least, greatest;
  for (int i = 0; i < resamples.count(); ++i) {
    const std::vector<std::size_t> winners = BestAt(runs, resamples[i], better);
    least.push_back(std::numeric_limits<double>::infinity());
    greatest.push_back(-std::numeric_limits<double>::infinity());
    for (const std::size_t winner : winners) {
      least.back() = std::min(least.back(), runs[winner].setting);
      greatest.back() = std::max(greatest.back(), runs[winner].setting);
      best.share_best[winner] += 1.0 / (resamples.count() * static_cast<double>(winners.size()));
    }
  }
  best.setting_interval =
      IntervalOfMembers(std::move(least), std::move(greatest), resamples.confidence());
  best.p_as_good = AdjustedAgainst(runs, best.index);
  for (const SettingRuns& r : runs) {
    best.regret_mean.push_back(Summarise(Regret(r.by_seed, runs[best.index].by_seed, better)).mean);
  }
  return best;
}

std::vector<double> BestOfEachSeed(const std::vector<SettingRuns>& runs, Better better) {
  RequireDirection(better);
  Require(!runs.empty(), "the best is one of at least one setting");
  std::vector<double> best = runs.front().by_seed;
  for (const SettingRuns& r : runs) {
    for (std::size_t i = 0; i < best.size(); ++i) {
      if (Loss(r.by_seed[i], better) < Loss(best[i], better)) best[i] = r.by_seed[i];
    }
  }
  return best;
}

std::vector<double> Regret(const std::vector<double>& by_seed,
                           const std::vector<double>& oracle_by_seed, Better better) {
  RequireDirection(better);
  Require(by_seed.size() == oracle_by_seed.size(), "both sides have the same seeds");
  std::vector<double> regret;
  for (std::size_t i = 0; i < by_seed.size(); ++i) {
    regret.push_back(Loss(by_seed[i], better) - Loss(oracle_by_seed[i], better));
  }
  return regret;
}

}  // namespace depthgrid
