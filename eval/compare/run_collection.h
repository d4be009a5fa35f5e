// Runs as one table, whatever holds them: a sweep, one run's folder, or a folder of runs' folders.
#pragma once

#include <string>

#include "eval/sweep/sweep_results.h"

namespace depthgrid {

// Runs that are no sweep's have as parameters what tells which of two runs belong together: of
// scene, trajectory, frames and the seeds what their run.yaml states. The scores of a run are its
// metrics.json, or, as of another mapper, trajectory.json and map.json with what `eval trajectory
// --json` and `eval map --json` print. Throws InputError when the folder holds none.
SweepResults ReadRuns(const std::string& folder);

}  // namespace depthgrid
