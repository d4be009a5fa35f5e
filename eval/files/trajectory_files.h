// Two trajectories that are to be compared, from files of either kind: TUM's, whose poses find each
// other by their stamps, or a matrix a pose (KITTI's), which has none.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/trajectory.h"

namespace depthgrid {

struct TrajectoryFiles {
  Trajectory reference;
  Trajectory estimate;
  // Where either file has no stamps, their rows belong together in order, and have the same stamps
  // here: those of the other file or, without seconds, the rows' numbers from 0.
  bool by_row = false;
  bool has_seconds = true;
  std::vector<std::string> warnings;
};

// Rows whose pose is missing in either file (NaN, damaged) pair with nothing and are counted.
// Throws InputError for files that do not pair by row: of other lengths, or a TUM file whose rows
// are not all poses in order of time.
TrajectoryFiles ReadTrajectoryFiles(const std::string& reference, const std::string& estimate);

}  // namespace depthgrid
