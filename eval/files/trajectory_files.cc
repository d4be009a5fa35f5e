#include "eval/files/trajectory_files.h"

#include <fmt/format.h>

#include <optional>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/pose_file.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {
namespace {

struct Rows {
  std::vector<std::optional<Pose3>> poses;
  std::vector<double> stamps_s;  // empty if the file has none
};

Rows RowsOfMatrices(const std::string& text, const std::string& path,
                    std::vector<std::string>& warnings) {
  Rows rows;
  rows.poses = ParseMatrixRows(text, path, warnings);
  return rows;
}

// A file that had to be corrected while reading is rejected, because its poses no longer correspond
// to its rows.
Rows RowsOfTum(const std::string& text, const std::string& path, const std::string& other,
               std::vector<std::string>& warnings) {
  const TrajectoryFile file = ParseTrajectory(text, path);
  const int mended = file.damage.damaged() + file.damage.left_out().count + file.unsorted_stamps +
                     file.doubled_stamps.count;
  if (mended > 0) {
    throw InputError(
        path, fmt::format("{} no pose or not later than the row before; must all be, as {} has no "
                          "stamps and rows pair in order",
                          mended == 1 ? "1 row is" : fmt::format("{} rows are", mended), other));
  }
  const auto said = file.Warnings(path);
  warnings.insert(warnings.end(), said.begin(), said.end());
  Rows rows;
  for (const auto& [stamp_s, pose] : file.poses) {
    rows.poses.emplace_back(pose);
    rows.stamps_s.push_back(stamp_s);
  }
  return rows;
}

Trajectory Stamped(const Rows& rows, const std::vector<double>& stamps_s, const std::string& path) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < rows.poses.size(); ++i) {
    const double stamp_s = stamps_s.empty() ? static_cast<double>(i) : stamps_s[i];
    if (rows.poses[i]) trajectory.push_back({stamp_s, *rows.poses[i]});
  }
  if (trajectory.empty()) throw InputError(path, "holds no pose");
  return trajectory;
}

}  // namespace

TrajectoryFiles ReadTrajectoryFiles(const std::string& reference, const std::string& estimate) {
  TrajectoryFiles files;
  const std::string reference_text = ReadTextFile(reference);
  const std::string estimate_text = ReadTextFile(estimate);
  const bool reference_matrices = HoldsMatrices(reference_text);
  const bool estimate_matrices = HoldsMatrices(estimate_text);
  files.by_row = reference_matrices || estimate_matrices;
  if (!files.by_row) {
    files.reference = ParsePoses(reference_text, reference, {}, files.warnings).poses;
    files.estimate = ParsePoses(estimate_text, estimate, {}, files.warnings).poses;
    return files;
  }
  const Rows of_reference = reference_matrices
                                ? RowsOfMatrices(reference_text, reference, files.warnings)
                                : RowsOfTum(reference_text, reference, estimate, files.warnings);
  const Rows of_estimate = estimate_matrices
                               ? RowsOfMatrices(estimate_text, estimate, files.warnings)
                               : RowsOfTum(estimate_text, estimate, reference, files.warnings);
  if (of_estimate.poses.size() != of_reference.poses.size()) {
    throw InputError(
        estimate, fmt::format("holds {}, must hold the {} of {}: {} has no stamps, so rows pair in "
                              "order",
                              Counted(of_estimate.poses.size(), "pose"), of_reference.poses.size(),
                              reference, estimate_matrices ? "it" : "that one"));
  }
  const std::vector<double>& stamps_s =
      of_reference.stamps_s.empty() ? of_estimate.stamps_s : of_reference.stamps_s;
  files.has_seconds = !stamps_s.empty();
  files.reference = Stamped(of_reference, stamps_s, reference);
  files.estimate = Stamped(of_estimate, stamps_s, estimate);
  return files;
}

}  // namespace depthgrid
