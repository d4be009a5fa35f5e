// Writes a sweep as a file with which it can be repeated elsewhere.
#pragma once

#include <cstdint>
#include <string>

#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// A sweep's file that, placed beside the experiment.yaml of a sweep's folder, defines the runs of
// `plan`: values of axes are listed, paths of files are absolute. `samples` and `sample_seed`: of a
// random sweep.
std::string SweepAgainText(const SweepPlan& plan, SweepMode mode, int samples,
                           std::uint64_t sample_seed);

}  // namespace depthgrid
