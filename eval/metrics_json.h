// Scores as the JSON of metrics.json and of `eval ... --json`, the same keys in both.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "eval/metrics/map_metrics.h"
#include "eval/metrics/trajectory_metrics.h"

namespace depthgrid {

nlohmann::ordered_json ToJson(const TrajectoryScore& score);
nlohmann::ordered_json ToJson(const MapScore& score);

// Two-space indent, numbers in the shortest form that reads back the same, a final line end.
std::string JsonText(const nlohmann::ordered_json& json);

}  // namespace depthgrid
