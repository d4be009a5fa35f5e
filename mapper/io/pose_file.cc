#include "mapper/io/pose_file.h"

#include <algorithm>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/matrix_poses.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/trajectory_columns.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr const char* kTumIsOtherwise =
    " (a TUM trajectory has 8 columns, t x y z qx qy qz qw, with decimal points)";

FilePoses StampedMatrices(const std::string& text, const std::string& place,
                          const FrameNames& frames, std::vector<std::string>& warnings) {
  const auto [poses, lack_is_told] =
      PairInOrder(ParseMatrixRows(text, place, warnings), frames, place, warnings);
  FilePoses stamped{{}, lack_is_told};
  for (std::size_t i = 0; i < std::min(poses.size(), frames.stamps_s.size()); ++i) {
    if (poses[i]) stamped.poses.push_back({frames.stamps_s[i], *poses[i]});
  }
  return stamped;
}

}  // namespace

bool HoldsMatrices(const std::string& text) {
  if (NamedColumns(text)) return false;
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
  RequireSomePose(poses, damage, place);
  damage.AppendTo(warnings, place);
  damage.left_out().AppendTo(warnings, place, "pose",
                             "with NaN, a zero rotation or beyond 10,000 km ignored");
  return poses;
}

FilePoses ParsePoses(const std::string& text, const std::string& place, const FrameNames& frames,
                     std::vector<std::string>& warnings) {
  if (HoldsMatrices(text)) {
    FilePoses stamped = StampedMatrices(text, place, frames, warnings);
    if (stamped.poses.empty()) throw InputError(place, "holds no pose of these frames");
    return stamped;
  }
  TrajectoryFile file = ParseTrajectory(text, place);
  const bool of_imu = file.of_imu;
  return {PosesOf(std::move(file), place, warnings), false, of_imu};
}

Trajectory ReadPoseFile(const std::string& path, const FrameNames& frames,
                        std::vector<std::string>& warnings) {
  return ParsePoses(ReadTextFile(path), path, frames, warnings).poses;
}

}  // namespace depthgrid
