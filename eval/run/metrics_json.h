// Scores as the JSON of metrics.json and of `eval ... --json`, the same keys in both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/metrics/map_metrics.h"
#include "eval/metrics/trajectory_metrics.h"
#include "eval/run/consistency.h"

namespace depthgrid {

struct NamedTrajectoryScore {
  std::string name;                      // slam, online, est
  std::optional<TrajectoryScore> score;  // null in the file when no stamps are shared
};

// `map` and `consistency` may be null. Numbers are in the shortest form that reads back the same;
// what is undefined is null.
std::string MetricsJson(const std::vector<NamedTrajectoryScore>& trajectories, const MapScore* map,
                        const ConsistencyScores* consistency = nullptr);

}  // namespace depthgrid
