// Poses written as matrices: camera to world, row-major.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/damage.h"

namespace depthgrid {

// A file with one 4x4 (or 3x4) matrix in four (three) lines, as in 7-Scenes and ScanNet for each
// frame. Nothing for NaN or infinity, with the reason in `left_out`: the frame has no pose. Throws
// InputError if it is not a rigid motion.
std::optional<Pose3> ReadMatrixPose(const std::string& path, Tally& left_out);
std::optional<Pose3> ParseMatrixPose(const std::string& text, const std::string& place);

// The pose that 12 or 16 numbers are, row-major. Throws InputError if they are no rigid motion.
Pose3 RigidMotionOf(std::span<const double> numbers, const std::string& place);

// A file with many matrices: one of 16 or 12 numbers per line, or in three or four lines of four
// numbers (ICL-NUIM's .gt.sim). Damaged ones stay in the list without a pose and are counted in
// `damage`, as are unusable ones (NaN, a zero rotation, beyond 10,000 km). Throws InputError unless
// the good outnumber the damaged; ReadMatrixPoses also when no pose is left.
std::vector<std::optional<Pose3>> ReadMatrixPoses(const std::string& path,
                                                  std::vector<std::string>& warnings);
std::vector<std::optional<Pose3>> ParseMatrixPoses(const std::string& text,
                                                   const std::string& place, RowDamage& damage);
// Throws InputError, with what was left out, if there is no pose.
void RequireSomePose(const std::vector<std::optional<Pose3>>& poses, const RowDamage& damage,
                     const std::string& place);

// KITTI's form: the upper three rows of each pose's matrix on one line, no stamps.
std::string MatrixPosesText(const Trajectory& trajectory);

}  // namespace depthgrid
