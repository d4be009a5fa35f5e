// The tables of a run's folder.
#pragma once

#include <string>

#include "eval/run/mapping_run.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

// frames.csv: one row an input frame, what the mapper knew and decided at the time. `truth` adds
// errors of the SLAM pose and of the online estimate (no alignment); empty cells where nothing is
// known.
std::string FramesCsv(const MappingRun& run, const Trajectory* truth);

// timing.csv: CPU microseconds of each stage, one row a frame.
std::string TimingCsv(const MappingRun& run);
// timing.json: totals, and the mapper's time a frame.
std::string TimingJson(const MappingRun& run, double wall_s_total, double cpu_s_total);

}  // namespace depthgrid
