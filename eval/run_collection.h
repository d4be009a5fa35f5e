// Runs as one table, whatever holds them: a sweep, one run's folder, or a folder of runs' folders.
#pragma once

#include <string>

#include "eval/sweep/sweep_results.h"

namespace depthgrid {

// Runs that are no sweep's have as parameters what tells which of two runs belong together: scene,
// trajectory, frames and the seeds of their run.yaml. Throws InputError when the folder holds none.
SweepResults ReadRuns(const std::string& folder);

}  // namespace depthgrid
