#include "mapper/io/trajectory_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/io/damage.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"
#include "mapper/io/stamp_order.h"
#include "mapper/io/trajectory_columns.h"

namespace depthgrid {
namespace {

// Nothing for a row that means "no pose", with the reason in `damage`.
std::optional<Pose3> PoseOf(const std::vector<double>& row, const TrajectoryColumns& columns,
                            const std::string& place, RowDamage& damage) {
  const auto [x, y, z] = columns.position;
  const auto [qx, qy, qz, qw] = columns.rotation;
  Pose3 pose{Eigen::Quaterniond(row[qw], row[qx], row[qy], row[qz]), {row[x], row[y], row[z]}};
  const double norm = pose.rotation.norm();
  if (!IsWithinReach(pose.translation)) {
    damage.LeaveOut(PositionBeyondReach(pose.translation, place));
    return {};
  }
  if (!std::isfinite(norm) || norm == 0.0) {
    damage.LeaveOut(fmt::format("{}: quaternion qx qy qz qw has norm {}, must be 1", place, norm));
    return {};
  }
  if (std::abs(norm - 1.0) > kMaxNormError) {
    throw InputError(place, fmt::format("quaternion qx qy qz qw has norm {:.6g}, must be 1", norm));
  }
  if (std::abs(norm - 1.0) > kExactNormError) pose.rotation.normalize();
  return pose;
}

// `seen`: the stamps of the poses before.
void AddRow(const TextRow& row, const TrajectoryColumns& columns, const std::string& place,
            std::unordered_set<double>& seen, TrajectoryFile& file) {
  const std::vector<double> numbers = NumbersIn(row, columns.count, place);
  const std::string row_place = PlaceOfLine(place, row.line);
  const double stamp_s = numbers[columns.stamp] / columns.units_a_second;
  RequireSeconds(stamp_s, row_place);
  const std::optional<Pose3> pose = PoseOf(numbers, columns, row_place, file.damage);
  if (!pose) return;
  if (!file.poses.empty() && stamp_s < file.poses.back().stamp_s) ++file.unsorted_stamps;
  if (!seen.insert(stamp_s).second) {
    file.doubled_stamps.Add(fmt::format("{}: stamp {}", row_place, stamp_s));
  }
  file.poses.push_back({stamp_s, *pose});
}

Trajectory SomePosesOf(TrajectoryFile file, const std::string& path) {
  if (file.poses.empty()) throw file.damage.NothingIn(path, "pose");
  return std::move(file.poses);
}

}  // namespace

std::vector<std::string> TrajectoryFile::Warnings(const std::string& name) const {
  std::vector<std::string> warnings;
  if (!taken.empty()) warnings.push_back(name + ": " + taken);
  damage.AppendTo(warnings, name);
  damage.left_out().AppendTo(warnings, name, "pose",
                             "with NaN, a zero quaternion or beyond 10,000 km ignored");
  WarnOfCount(warnings, name, unsorted_stamps, "row", "earlier than the row before, sorted");
  if (clock_doubt) warnings.push_back(*clock_doubt);
  doubled_stamps.AppendTo(warnings, name, "row", "with a stamp already given, ignored");
  return warnings;
}

TrajectoryFile ParseTrajectory(const std::string& text, const std::string& place) {
  TrajectoryFile file;
  const std::vector<TextRow> rows = SplitRows(text);
  RequirePlainColumns(rows, place);
  const TrajectoryColumns columns = ColumnsOf(text, rows, place);
  file.taken = columns.taken;
  file.of_imu = columns.of_imu;
  std::unordered_set<double> seen;
  std::vector<int> lines;  // of the poses
  for (const TextRow& row : rows) {
    if (row.line == columns.header_line) continue;
    file.damage.Try([&] { AddRow(row, columns, place, seen, file); });
    if (lines.size() < file.poses.size()) lines.push_back(row.line);
  }
  file.damage.RequireMostGood(text);
  if (file.unsorted_stamps > 0) {
    file.clock_doubt = DoubtOfSorted(StampsOf(file.poses), lines, place);
  }
  const auto stamp_less = [](const auto& a, const auto& b) { return a.stamp_s < b.stamp_s; };
  const auto stamp_equal = [](const auto& a, const auto& b) { return a.stamp_s == b.stamp_s; };
  std::stable_sort(file.poses.begin(), file.poses.end(), stamp_less);
  file.poses.erase(std::unique(file.poses.begin(), file.poses.end(), stamp_equal),
                   file.poses.end());
  return file;
}

TrajectoryFile ReadTrajectoryFile(const std::string& path) {
  return ParseTrajectory(ReadTextFile(path), path);
}

Trajectory ReadTrajectory(const std::string& path) {
  TrajectoryFile file = ReadTrajectoryFile(path);
  file.damage.RequireAllGood();
  return SomePosesOf(std::move(file), path);
}

Trajectory ReadTrajectory(const std::string& path, std::vector<std::string>& warnings) {
  return PosesOf(ReadTrajectoryFile(path), path, warnings);
}

Trajectory PosesOf(TrajectoryFile file, const std::string& place,
                   std::vector<std::string>& warnings) {
  const auto mended = file.Warnings(place);
  warnings.insert(warnings.end(), mended.begin(), mended.end());
  return SomePosesOf(std::move(file), place);
}

std::string TrajectoryText(const Trajectory& trajectory) {
  std::string text;
  for (const auto& [stamp_s, pose] : trajectory) {
    const auto& t = pose.translation;
    const auto& q = pose.rotation;
    text += fmt::format("{:.6f} {} {} {} {} {} {} {}\n", stamp_s, t.x(), t.y(), t.z(), q.x(), q.y(),
                        q.z(), q.w());
  }
  return text;
}

void WriteTrajectory(const std::string& path, const Trajectory& trajectory) {
  WriteFile(path, TrajectoryText(trajectory));
}

}  // namespace depthgrid
