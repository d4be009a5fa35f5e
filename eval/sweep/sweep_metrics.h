// The scores of a run as columns of a sweep's table.
#pragma once

#include <string>
#include <vector>

#include "eval/run/experiment.h"
#include "eval/sweep/sweep_database.h"

namespace depthgrid {

// The figures of metrics.json under their paths there, less what only breaks a figure down: full
// statistics of an error, other tolerances, confusion, counts of cells and poses. A run gives all.
NamedValues SweepMetrics(const RunScores& scores);

// Their names.
std::vector<std::string> SweepMetricNames();

}  // namespace depthgrid
