// Reads runs into one table, from a sweep, a run's folder, or a folder of runs' folders.
#pragma once

#include <string>

#include "eval/sweep/sweep_results.h"

namespace depthgrid {

// Runs that are not part of a sweep have as parameters what determines pairs: scene, trajectory,
// frames and seeds, as far as their run.yaml gives them. The scores of a run are its metrics.json
// or, for other mappers, trajectory.json and map.json with the output of `eval trajectory --json`
// and `eval map --json`. Throws InputError when the folder contains no runs.
SweepResults ReadRuns(const std::string& folder);

}  // namespace depthgrid
