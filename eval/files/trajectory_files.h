// Reads two trajectories to be compared, from TUM files, whose poses are paired by stamps, or files
// with one matrix per pose (KITTI's), which have no stamps.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/trajectory.h"

namespace depthgrid {

struct TrajectoryFiles {
  Trajectory reference;
  Trajectory estimate;
  // If either file has no stamps, rows are paired in order and have equal stamps here: those of the
  // other file or, if neither has stamps, row numbers from 0.
  bool by_row = false;
  bool has_seconds = true;
  std::vector<std::string> warnings;
};

// Rows whose pose is missing in either file (NaN, damaged) are left out and counted. Throws
// InputError for files that cannot be paired by row: with different lengths, or a TUM file whose
// rows are not all poses in order of time.
TrajectoryFiles ReadTrajectoryFiles(const std::string& reference, const std::string& estimate);

}  // namespace depthgrid
