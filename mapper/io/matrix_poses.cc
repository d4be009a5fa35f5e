#include "mapper/io/matrix_poses.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>
#include <iterator>
#include <span>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Printed digits leave errors of 1e-4; more is another kind of matrix.
constexpr double kMaxRotationError = 0.02;

// `numbers`: 12 or 16, row by row.
std::optional<Pose3> PoseOf(std::span<const double> numbers, const std::string& place) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) return {};
  }
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
    }
    translation[row] = numbers[static_cast<std::size_t>(4 * row + 3)];
  }
  if (rotation.isZero()) return {};
  const bool last_row_ok = numbers.size() == 12 || (numbers[12] == 0.0 && numbers[13] == 0.0 &&
                                                    numbers[14] == 0.0 && numbers[15] == 1.0);
  if (!last_row_ok) throw InputError(place, "the matrix's last row must be 0 0 0 1");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if ((nearest - rotation).cwiseAbs().maxCoeff() > kMaxRotationError ||
      nearest.determinant() < 0.0) {
    throw InputError(place, "the matrix's upper left 3x3 must be a rotation");
  }
  return Pose3{Eigen::Quaterniond(nearest).normalized(), translation};
}

}  // namespace

std::optional<Pose3> ParseMatrixPose(const std::string& text, const std::string& place) {
  const auto poses = ParseMatrixPoses(text, place);
  if (poses.size() != 1) {
    throw InputError(place, fmt::format("holds {} poses, must hold one 4x4 matrix", poses.size()));
  }
  return poses.front();
}

std::vector<std::optional<Pose3>> ParseMatrixPoses(const std::string& text,
                                                   const std::string& place) {
  const std::vector<TextRow> rows = SplitRows(text);
  if (rows.empty()) return {};
  const std::size_t columns = rows.front().fields.size();
  if (columns != 4 && columns != 12 && columns != 16) {
    throw InputError(PlaceOfLine(place, rows.front().line),
                     fmt::format("has {} columns, must be a row of a matrix (4) or a whole matrix "
                                 "(12 or 16)",
                                 columns));
  }
  std::vector<std::optional<Pose3>> poses;
  std::vector<double> block;
  // Four lines of four when each fourth is 0 0 0 1, otherwise three.
  std::size_t block_size = columns == 4 ? 12 : columns;
  if (columns == 4 && rows.size() % 4 == 0) {
    const std::vector<double> fourth = NumbersIn(rows[3], 4, place);
    if (fourth == std::vector<double>{0.0, 0.0, 0.0, 1.0} || rows.size() == 4) block_size = 16;
  }
  for (const TextRow& row : rows) {
    const std::vector<double> numbers = NumbersIn(row, columns, place);
    block.insert(block.end(), numbers.begin(), numbers.end());
    if (block.size() < block_size) continue;
    poses.push_back(PoseOf(block, PlaceOfLine(place, row.line)));
    block.clear();
  }
  if (!block.empty()) {
    throw InputError(PlaceOfLine(place, rows.back().line), "the last matrix is incomplete");
  }
  return poses;
}

std::optional<Pose3> ReadMatrixPose(const std::string& path) {
  return ParseMatrixPose(ReadFile(path), path);
}

std::vector<std::optional<Pose3>> ReadMatrixPoses(const std::string& path) {
  return ParseMatrixPoses(ReadFile(path), path);
}

std::string MatrixPosesText(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& stamped : trajectory) {
    const Eigen::Matrix3d rotation = stamped.world_from_camera.rotation.toRotationMatrix();
    const Eigen::Vector3d& translation = stamped.world_from_camera.translation;
    for (int row = 0; row < 3; ++row) {
      fmt::format_to(std::back_inserter(text), "{} {} {} {}{}", rotation(row, 0), rotation(row, 1),
                     rotation(row, 2), translation[row], row == 2 ? "\n" : " ");
    }
  }
  return text;
}

}  // namespace depthgrid
