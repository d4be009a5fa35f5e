#include "mapper/io/pose_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

constexpr std::size_t kTumColumns = 8;

bool HoldsMatrices(const std::string& text) {
  const std::vector<TextRow> rows = SplitRows(text);
  const std::size_t columns = rows.empty() ? kTumColumns : rows.front().fields.size();
  return columns == 4 || columns == 12 || columns == 16;
}

Trajectory InOrder(const std::vector<std::optional<Pose3>>& poses, const std::string& place,
                   const std::vector<double>& stamps_s, std::vector<std::string>& warnings) {
  if (poses.size() != stamps_s.size()) {
    warnings.push_back(fmt::format("{}: {} poses for {} frames, paired from the first", place,
                                   poses.size(), stamps_s.size()));
  }
  Trajectory trajectory;
  int invalid = 0;
  for (std::size_t i = 0; i < std::min(poses.size(), stamps_s.size()); ++i) {
    if (poses[i]) {
      trajectory.push_back({stamps_s[i], *poses[i]});
    } else {
      ++invalid;
    }
  }
  if (invalid > 0) warnings.push_back(fmt::format("{}: {} poses with NaN ignored", place, invalid));
  return trajectory;
}

}  // namespace

Trajectory ParsePoses(const std::string& text, const std::string& place,
                      const std::vector<double>& frame_stamps_s,
                      std::vector<std::string>& warnings) {
  Trajectory poses;
  if (HoldsMatrices(text)) {
    poses = InOrder(ParseMatrixPoses(text, place), place, frame_stamps_s, warnings);
  } else {
    TrajectoryFile file = ParseTrajectory(text, place);
    const auto mended = file.Warnings(place);
    warnings.insert(warnings.end(), mended.begin(), mended.end());
    poses = std::move(file.poses);
  }
  if (poses.empty()) throw InputError(place, "holds no pose");
  return poses;
}

Trajectory ReadPoseFile(const std::string& path, const std::vector<double>& frame_stamps_s,
                        std::vector<std::string>& warnings) {
  return ParsePoses(ReadFile(path), path, frame_stamps_s, warnings);
}

}  // namespace depthgrid
