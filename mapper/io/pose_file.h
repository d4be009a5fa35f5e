// Reads the poses of a sequence from a trajectory (trajectory_file.h) or a file of matrices.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/frame_names.h"

namespace depthgrid {

struct FilePoses {
  Trajectory poses;
  bool lack_is_told = false;  // SlamOutput::lack_is_told
  bool of_imu = false;  // a trajectory in the form in which EuRoC and VINS give an IMU's poses
};

// A trajectory, or one matrix per frame (4x4 or 3x4, row-major, camera to world, as KITTI's),
// which gets the frames' stamps (PairInOrder). Repairs are added to `warnings`. Throws InputError,
// also when there is no pose.
Trajectory ReadPoseFile(const std::string& path, const FrameNames& frames,
                        std::vector<std::string>& warnings);
FilePoses ParsePoses(const std::string& text, const std::string& place, const FrameNames& frames,
                     std::vector<std::string>& warnings);

// Whether the text has matrices (4, 12 or 16 columns in its first rows, which no header names)
// rather than a trajectory.
bool HoldsMatrices(const std::string& text);
// The matrices of such a text; entries without a pose (NaN, damaged) are empty. Repairs are added
// to `warnings`. Throws InputError.
std::vector<std::optional<Pose3>> ParseMatrixRows(const std::string& text, const std::string& place,
                                                  std::vector<std::string>& warnings);

}  // namespace depthgrid
