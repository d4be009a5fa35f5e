// Poses written as matrices: camera to world, row-major.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/damage.h"

namespace depthgrid {

// A file with one 4x4 (or 3x4) matrix in four (three) lines, as 7-Scenes and ScanNet give each
// frame. Nothing when it holds NaN or infinity: the frame has no pose, and `left_out` says why.
// Throws InputError when it is no rigid motion.
std::optional<Pose3> ReadMatrixPose(const std::string& path, Tally& left_out);
std::optional<Pose3> ParseMatrixPose(const std::string& text, const std::string& place);

// A file with many: one of 16 or 12 numbers a line, or three or four lines of four numbers each
// (ICL-NUIM's .gt.sim). Damaged ones keep their place without a pose and are counted in `damage`,
// which leaves out those of NaN, a zero rotation or beyond 10,000 km. Throws InputError when the
// damaged are not fewer than the others; reading a file, also when no pose is left.
std::vector<std::optional<Pose3>> ReadMatrixPoses(const std::string& path,
                                                  std::vector<std::string>& warnings);
std::vector<std::optional<Pose3>> ParseMatrixPoses(const std::string& text,
                                                   const std::string& place, RowDamage& damage);
// Throws InputError, with what was left out, when there is none among what was parsed.
void RequireSomePose(const std::vector<std::optional<Pose3>>& poses, const RowDamage& damage,
                     const std::string& place);

// KITTI's form: the upper three rows of each pose's matrix on one line, no stamps.
std::string MatrixPosesText(const Trajectory& trajectory);

}  // namespace depthgrid
