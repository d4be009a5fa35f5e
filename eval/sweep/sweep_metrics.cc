#include "eval/sweep/sweep_metrics.h"

#include "eval/files/metric_columns.h"
#include "eval/output/run_folder.h"

namespace depthgrid {

NamedValues SweepMetrics(const RunScores& scores) {
  return MetricColumns(MetricsOf(scores), "metrics.json");
}

RunScores FullScores() {
  RunScores scores;
  scores.slam.emplace();
  scores.online.emplace();
  scores.est.emplace();
  scores.map.observable.emplace();
  MapQuality& quality = scores.map.quality.emplace();
  quality.registration.emplace();
  quality.registered.emplace();
  quality.thickness.emplace();
  quality.true_thickness.emplace();
  quality.calibration.emplace();
  quality.navigability.emplace();
  return scores;
}

std::vector<std::string> SweepMetricNames() {
  std::vector<std::string> names;
  for (const auto& [name, value] : SweepMetrics(FullScores())) names.push_back(name);
  return names;
}

}  // namespace depthgrid
