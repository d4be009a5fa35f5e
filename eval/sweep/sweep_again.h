// A sweep as a file of its own, to do it again elsewhere.
#pragma once

#include <cstdint>
#include <string>

#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// A sweep's file that, beside the experiment.yaml of a sweep's folder, asks for the runs of `plan`:
// axes written out, names of files whole. `samples` and `sample_seed`: of a random sweep.
std::string SweepAgainText(const SweepPlan& plan, SweepMode mode, int samples,
                           std::uint64_t sample_seed);

}  // namespace depthgrid
