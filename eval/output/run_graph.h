// The pose graph of a run, as other programs read it.
#pragma once

#include "eval/run/mapping_run.h"
#include "mapper/io/g2o_file.h"

namespace depthgrid {

// A vertex for each mapped frame at its final pose (the id is the input frame's number), an edge
// for each motion that SLAM saw between two of them, and one for each loop that was taken. The
// sigmas of the motions are how far they are from the final poses, root mean square over the run.
PlanarGraph GraphOf(const MappingRun& run);

}  // namespace depthgrid
