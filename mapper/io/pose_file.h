// Poses of a sequence from a file of either kind.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/trajectory.h"

namespace depthgrid {

// A TUM trajectory, or a matrix a frame (4x4 or 3x4, row-major, camera to world; KITTI's), which
// take the stamps of the frames in order. What had to be mended goes to `warnings`. Throws
// InputError, also when there is no pose.
Trajectory ReadPoseFile(const std::string& path, const std::vector<double>& frame_stamps_s,
                        std::vector<std::string>& warnings);
Trajectory ParsePoses(const std::string& text, const std::string& place,
                      const std::vector<double>& frame_stamps_s,
                      std::vector<std::string>& warnings);

}  // namespace depthgrid
