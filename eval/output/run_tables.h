#pragma once

#include <string>

#include "eval/run/mapping_run.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

// frames.csv: one row per input frame, with what the mapper knew and decided then. `truth` (may be
// null) adds errors of SLAM's pose and the online estimate, without alignment. Unknown cells are
// empty.
std::string FramesCsv(const MappingRun& run, const Trajectory* truth);

// timing.csv: CPU microseconds of each stage, one row per frame.
std::string TimingCsv(const MappingRun& run);
// timing.json: totals, and the mapper's time per frame.
std::string TimingJson(const MappingRun& run, double wall_s_total, double cpu_s_total);

}  // namespace depthgrid
