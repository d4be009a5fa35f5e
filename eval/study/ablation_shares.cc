#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "eval/files/json_text_impl.h"
#include "eval/metrics/statistics.h"
#include "eval/statistics/holm.h"
#include "eval/statistics/metric_direction.h"
#include "eval/statistics/score_names.h"
#include "eval/study/ablation.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

double ValueOf(const AblationRun& run, const std::string& metric) {
  for (const auto& [name, value] : run.metrics) {
    if (name == metric) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

// The scores that all runs have; a map without walls lacks some.
std::vector<std::string> ScoresOf(const std::vector<AblationRun>& runs) {
  std::vector<std::string> names;
  for (const AblationRun& run : runs) {
    for (const auto& [name, value] : run.metrics) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

// Errors are metres or shares, computed from numbers around 1. Smaller values are rounding errors,
// and would look like a difference common to all seeds.
double WithoutResidue(double value) {
  constexpr double kResidue = 1e-12;
  return std::abs(value) < kResidue ? 0.0 : value;
}

// A variant's errors by seed; 1 - score for scores that are better when higher.
std::vector<double> ErrorsOf(const std::vector<AblationRun>& runs, const std::string& variant,
                             const std::string& metric) {
  const bool complement = BetterOf(metric) == Better::kHigher;
  std::vector<double> errors;
  for (const AblationRun& run : runs) {
    if (run.variant != variant) continue;
    const double value = ValueOf(run, metric);
    errors.push_back(WithoutResidue(complement ? 1.0 - value : value));
  }
  return errors;
}

// The decrease of the errors from `before` to `after`.
PairedComparison GainOf(const std::vector<double>& before, std::vector<double> after,
                        const Resamples& resamples) {
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (WithoutResidue(after[i] - before[i]) == 0.0) after[i] = before[i];
  }
  PairedComparison gain = ComparePaired(before, after, Better::kLower, resamples);
  gain.mean_difference = WithoutResidue(gain.mean_difference);
  if (gain.mean_interval) {
    gain.mean_interval->low = WithoutResidue(gain.mean_interval->low);
    gain.mean_interval->high = WithoutResidue(gain.mean_interval->high);
  }
  return gain;
}

bool AllFinite(const std::vector<AblationRun>& runs, const std::string& metric) {
  return std::all_of(runs.begin(), runs.end(),
                     [&](const AblationRun& run) { return std::isfinite(ValueOf(run, metric)); });
}

ErrorShares SharesOfScore(const std::vector<AblationRun>& runs, const std::string& metric) {
  ErrorShares shares;
  shares.metric = metric;
  shares.is_complement = BetterOf(metric) == Better::kHigher;
  const std::vector<double> as_it_is = ErrorsOf(runs, AblationVariants().front().name, metric);
  shares.error = Summarise(as_it_is).mean;
  const Resamples resamples(as_it_is.size());
  std::vector<double> p_values;
  for (const AblationVariant& variant : AblationVariants()) {
    if (variant.against.empty()) continue;
    const std::vector<double> errors = ErrorsOf(runs, variant.name, metric);
    StageShare stage;
    stage.variant = variant.name;
    stage.error = Summarise(errors).mean;
    stage.gain = GainOf(ErrorsOf(runs, variant.against, metric), errors, resamples);
    if (shares.error > 0.0) stage.share = (0.0 - stage.gain.mean_difference) / shares.error;
    p_values.push_back(stage.gain.wilcoxon.p_value);
    shares.stages.push_back(std::move(stage));
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  for (std::size_t i = 0; i < adjusted.size(); ++i) shares.stages[i].p_holm = adjusted[i];
  return shares;
}

}  // namespace

std::vector<AblationRun> WithoutRepeatedSeeds(const std::vector<AblationRun>& runs) {
  std::map<std::uint64_t, std::string> scores_of_seed;
  for (const AblationRun& run : runs) {
    std::string& scores = scores_of_seed[run.seed];
    scores += run.variant;
    for (const auto& [name, value] : run.metrics) scores += fmt::format(" {}", value);
  }
  std::map<std::string, std::uint64_t> first_with;
  std::vector<AblationRun> kept;
  for (const AblationRun& run : runs) {
    const auto first = first_with.try_emplace(scores_of_seed[run.seed], run.seed).first;
    if (first->second == run.seed) kept.push_back(run);
  }
  return kept;
}

std::vector<ErrorShares> SharesOf(const std::vector<AblationRun>& runs) {
  Require(!runs.empty(), "shares are of at least one run");
  std::vector<ErrorShares> all;
  for (const std::string_view name : ScoresOfAnAblation()) {
    const std::string metric(name);
    if (AllFinite(runs, metric)) all.push_back(SharesOfScore(runs, metric));
  }
  return all;
}

std::string AblationCsv(const std::vector<AblationRun>& runs) {
  std::string csv = "variant,seed";
  const std::vector<std::string> columns = ScoresOf(runs);
  for (const std::string& name : columns) csv += "," + name;
  csv += "\n";
  for (const AblationRun& run : runs) {
    csv += fmt::format("{},{}", run.variant, run.seed);
    for (const std::string& name : columns) {
      const double value = ValueOf(run, name);
      csv += std::isnan(value) ? "," : fmt::format(",{}", value);
    }
    csv += "\n";
  }
  return csv;
}

std::string AblationJson(const std::vector<ErrorShares>& shares, std::size_t seeds,
                         const std::string& scene) {
  nlohmann::ordered_json json = {{"scene", scene}, {"seeds", seeds}};
  for (const ErrorShares& score : shares) {
    nlohmann::ordered_json& entry = json["scores"][score.metric];
    entry["error_is"] = score.is_complement ? "one less the score" : "the score";
    entry["error"] = score.error;
    for (std::size_t i = 0; i < score.stages.size(); ++i) {
      const StageShare& stage = score.stages[i];
      nlohmann::ordered_json& cell = entry["truth_for"][stage.variant];
      cell["compared_with"] = AblationVariants()[i + 1].against;
      cell["error"] = stage.error;
      cell["owned"] = 0.0 - stage.gain.mean_difference;
      cell["share"] = stage.share ? nlohmann::ordered_json(*stage.share) : nullptr;
      cell["owned_interval95"] = nullptr;
      if (const auto& interval = stage.gain.mean_interval) {
        cell["owned_interval95"] = {0.0 - interval->high, 0.0 - interval->low};
      }
      cell["p_value"] = stage.gain.wilcoxon.p_value;
      cell["p_holm"] = stage.p_holm;
    }
  }
  return JsonText(json, 2) + "\n";
}

}  // namespace depthgrid
