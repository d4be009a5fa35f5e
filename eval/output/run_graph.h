// The pose graph of a run, for other programs.
#pragma once

#include "eval/run/mapping_run.h"
#include "mapper/io/g2o_file.h"

namespace depthgrid {

// A vertex for each mapped frame at its final pose (the id is the input frame's number), an edge
// for each of SLAM's motions between two of them, and one for each accepted loop. The sigmas of the
// motions are their RMS differences from the final poses over the run.
PlanarGraph GraphOf(const MappingRun& run);

}  // namespace depthgrid
