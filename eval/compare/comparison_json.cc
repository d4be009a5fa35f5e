#include <nlohmann/json.hpp>

#include "eval/compare/comparison.h"
#include "eval/files/json_text_impl.h"
#include "eval/statistics/metric_direction.h"

namespace depthgrid {
namespace {

using Json = nlohmann::ordered_json;

const char* NameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kABetter:
      return "a";
    case Verdict::kBBetter:
      return "b";
    case Verdict::kAHigher:
      return "a_higher";
    case Verdict::kBHigher:
      return "b_higher";
    case Verdict::kTooFew:
      return "too_few_pairs";
    case Verdict::kNotTested:
      return "not_tested";
    case Verdict::kNotToldApart:
      break;
  }
  return "not_told_apart";
}

Json ToJson(const MetricComparison& c) {
  const PairedComparison& p = c.paired;
  const Json interval =
      p.mean_interval ? Json{p.mean_interval->low, p.mean_interval->high} : Json();
  return {{"better", NameOf(c.better)},
          {"distance_from", c.target ? Json(*c.target) : Json()},
          {"pairs", p.pairs},
          {"undefined_pairs", c.undefined_pairs},
          {"mean_a", p.mean_a},
          {"mean_b", p.mean_b},
          {"mean_difference", p.mean_difference},
          {"mean_difference_interval95", interval},
          {"median_difference", p.median_difference},
          {"std_difference", p.std_difference},
          {"a_wins", p.a_wins},
          {"b_wins", p.b_wins},
          {"p_value", p.wilcoxon.p_value},
          {"p_holm", c.verdict == Verdict::kNotTested ? Json() : Json(c.p_holm)},
          {"exact", p.wilcoxon.exact},
          {"rank_biserial", p.wilcoxon.rank_biserial},
          {"seeds_needed", c.seeds_needed ? Json(*c.seeds_needed) : Json()},
          {"verdict", NameOf(c.verdict)}};
}

}  // namespace

std::string ComparisonJson(const Comparison& comparison, const std::string& a,
                           const std::string& b) {
  Json json = {{"a", a},
               {"b", b},
               {"paired_by", comparison.paired_by},
               {"different", Json::object()},
               {"pairs", comparison.pairs},
               {"units", comparison.units},
               {"crossed_seeds", comparison.crossed_seeds},
               {"runs_a", comparison.runs_a},
               {"runs_b", comparison.runs_b},
               {"pairs_for_one_row", comparison.pairs_for_one},
               {"pairs_for_all_rows", comparison.pairs_for_all},
               {"unpaired_a", comparison.unpaired_a},
               {"unpaired_b", comparison.unpaired_b},
               {"repeated_seeds", comparison.repeated_seeds},
               {"undefined", comparison.undefined},
               {"without_direction", comparison.without_direction},
               {"all_equal", comparison.all_equal},
               {"metrics", Json::object()}};
  for (const DifferentSetting& setting : comparison.different) {
    json["different"][setting.key] = {setting.a, setting.b};
  }
  for (const MetricComparison& compared : comparison.metrics) {
    json["metrics"][compared.metric] = ToJson(compared);
  }
  return JsonText(json, 2) + "\n";
}

}  // namespace depthgrid
