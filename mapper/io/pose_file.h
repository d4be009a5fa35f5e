// Poses of a sequence from a file of either kind.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/frame_names.h"

namespace depthgrid {

// A TUM trajectory, or a matrix a frame (4x4 or 3x4, row-major, camera to world; KITTI's), which
// take the stamps of the frames (PairInOrder). What had to be mended goes to `warnings`. Throws
// InputError, also when there is no pose.
Trajectory ReadPoseFile(const std::string& path, const FrameNames& frames,
                        std::vector<std::string>& warnings);
Trajectory ParsePoses(const std::string& text, const std::string& place, const FrameNames& frames,
                      std::vector<std::string>& warnings);

}  // namespace depthgrid
