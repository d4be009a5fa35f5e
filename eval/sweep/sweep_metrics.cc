#include "eval/sweep/sweep_metrics.h"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "eval/run_folder.h"

namespace depthgrid {
namespace {

constexpr std::array<std::string_view, 5> kBreakdowns = {"xy", "xyz", "rotation_rad", "rpe",
                                                         "confusion"};

bool IsBreakdown(const std::string& key) {
  return key.starts_with("tolerance_") || key.ends_with("_cells") || key.ends_with("_poses") ||
         std::find(kBreakdowns.begin(), kBreakdowns.end(), key) != kBreakdowns.end();
}

void Collect(const nlohmann::ordered_json& json, const std::string& path, NamedValues& values) {
  for (const auto& [key, value] : json.items()) {
    if (IsBreakdown(key)) continue;
    const std::string name = path.empty() ? key : path + "." + key;
    if (value.is_object()) {
      Collect(value, name, values);
    } else if (value.is_number()) {
      values.emplace_back(name, value.get<double>());
    } else if (value.is_null()) {
      values.emplace_back(name, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

}  // namespace

NamedValues SweepMetrics(const RunScores& scores) {
  NamedValues values;
  Collect(nlohmann::ordered_json::parse(MetricsOf(scores)), "", values);
  return values;
}

}  // namespace depthgrid
