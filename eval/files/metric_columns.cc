#include "eval/files/metric_columns.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "eval/statistics/score_names.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

using Columns = std::vector<std::pair<std::string, double>>;

void Collect(const nlohmann::ordered_json& json, const std::string& path, Columns& columns) {
  for (const auto& [key, value] : json.items()) {
    const std::string name = path.empty() ? key : path + "." + key;
    if (IsBreakdown(name)) continue;
    if (value.is_object()) {
      Collect(value, name, columns);
    } else if (value.is_number()) {
      columns.emplace_back(name, value.get<double>());
    } else if (value.is_null() && !IsGroupOfScores(name)) {
      columns.emplace_back(name, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

}  // namespace

std::string DistanceName(const std::string& metric, double target) {
  return target == 0.0 ? fmt::format("|{}|", metric) : fmt::format("|{} - {}|", metric, target);
}

Columns MetricColumns(const std::string& metrics_json, const std::string& place) {
  const auto json = nlohmann::ordered_json::parse(metrics_json, nullptr, false);
  if (!json.is_object()) throw InputError(place, "is no JSON object");
  Columns columns;
  Collect(json, "", columns);
  return columns;
}

}  // namespace depthgrid
