// The scores of a run as columns of a sweep's table.
#pragma once

#include <string>
#include <vector>

#include "eval/run/experiment.h"
#include "eval/sweep/sweep_database.h"

namespace depthgrid {

// MetricColumns() of the run's metrics.json.
NamedValues SweepMetrics(const RunScores& scores);

// Scores with every optional part present.
RunScores FullScores();
// The names of its columns.
std::vector<std::string> SweepMetricNames();

}  // namespace depthgrid
