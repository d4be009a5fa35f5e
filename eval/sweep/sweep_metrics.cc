#include "eval/sweep/sweep_metrics.h"

#include "eval/metric_columns.h"
#include "eval/run_folder.h"

namespace depthgrid {

NamedValues SweepMetrics(const RunScores& scores) {
  return MetricColumns(MetricsOf(scores), "metrics.json");
}

}  // namespace depthgrid
