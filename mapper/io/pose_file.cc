#include "mapper/io/pose_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr const char* kTumIsOtherwise =
    " (a TUM trajectory has 8 columns, t x y z qx qy qz qw, with decimal points)";

Trajectory StampedMatrices(const std::string& text, const std::string& place,
                           const FrameNames& frames, std::vector<std::string>& warnings) {
  const auto poses = PairInOrder(ParseMatrixRows(text, place, warnings), frames, place, warnings);
  Trajectory trajectory;
  for (std::size_t i = 0; i < std::min(poses.size(), frames.stamps_s.size()); ++i) {
    if (poses[i]) trajectory.push_back({frames.stamps_s[i], *poses[i]});
  }
  return trajectory;
}

}  // namespace

bool HoldsMatrices(const std::string& text) {
  constexpr std::size_t kLooksAt = 10;  // the first few may be damaged
  int matrices = 0;
  const std::vector<TextRow> rows = SplitRows(text);
  for (std::size_t i = 0; i < std::min(kLooksAt, rows.size()); ++i) {
    const std::size_t columns = rows[i].fields.size();
    if (columns == 4 || columns == 12 || columns == 16) ++matrices;
    if (columns == kTumColumns) --matrices;
  }
  return matrices > 0;
}

std::vector<std::optional<Pose3>> ParseMatrixRows(const std::string& text, const std::string& place,
                                                  std::vector<std::string>& warnings) {
  RequirePlainColumns(SplitRows(text), place);
  RowDamage damage;
  auto poses = [&] {
    try {
      return ParseMatrixPoses(text, place, damage);
    } catch (const InputError& error) {
      // Four columns are also a trajectory without rotations, 16 one with decimal commas.
      throw InputError("", std::string(error.what()) + kTumIsOtherwise);
    }
  }();
  const auto empty = std::count(poses.begin(), poses.end(), std::nullopt);
  damage.AppendTo(warnings, place);
  if (empty > damage.damaged()) {
    warnings.push_back(
        fmt::format("{}: {} with NaN ignored", place, Counted(empty - damage.damaged(), "pose")));
  }
  return poses;
}

Trajectory ParsePoses(const std::string& text, const std::string& place, const FrameNames& frames,
                      std::vector<std::string>& warnings) {
  Trajectory poses;
  if (HoldsMatrices(text)) {
    poses = StampedMatrices(text, place, frames, warnings);
  } else {
    TrajectoryFile file = ParseTrajectory(text, place);
    const auto mended = file.Warnings(place);
    warnings.insert(warnings.end(), mended.begin(), mended.end());
    poses = std::move(file.poses);
  }
  if (poses.empty()) throw InputError(place, "holds no pose");
  return poses;
}

Trajectory ReadPoseFile(const std::string& path, const FrameNames& frames,
                        std::vector<std::string>& warnings) {
  return ParsePoses(ReadTextFile(path), path, frames, warnings);
}

}  // namespace depthgrid
