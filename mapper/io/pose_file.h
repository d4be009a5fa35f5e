// Poses of a sequence from a file of either kind.
#pragma once

#include <optional>
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

// Whether the text is of matrices rather than a TUM trajectory: its first rows have 4, 12 or 16
// columns.
bool HoldsMatrices(const std::string& text);
// The matrices of such a text, those without a pose (NaN, damaged) in their places. What had to be
// mended goes to `warnings`. Throws InputError.
std::vector<std::optional<Pose3>> ParseMatrixRows(const std::string& text, const std::string& place,
                                                  std::vector<std::string>& warnings);

}  // namespace depthgrid
