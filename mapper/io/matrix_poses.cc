#include "mapper/io/matrix_poses.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/frame.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Rounding of printed digits gives errors of 1e-4; more means another kind of matrix.
constexpr double kMaxRotationError = 0.02;

// `numbers`: 12 or 16, row-major. Nothing if they mean "no pose", with the reason in `damage`.
std::optional<Pose3> PoseOf(std::span<const double> numbers, const std::string& place,
                            RowDamage& damage) {
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(numbers.begin(), numbers.end(), is_finite)) {
    damage.LeaveOut(place + ": the matrix must be finite");
    return {};
  }
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
    }
    translation[row] = numbers[static_cast<std::size_t>(4 * row + 3)];
  }
  if (!IsWithinReach(translation)) {
    damage.LeaveOut(PositionBeyondReach(translation, place));
    return {};
  }
  if (rotation.isZero()) {
    damage.LeaveOut(place + ": the matrix's upper left 3x3 is zero, must be a rotation");
    return {};
  }
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

// The layout of a file's matrices: lines per matrix and numbers per line.
struct Layout {
  std::size_t lines = 1;
  std::size_t columns = 12;
};

bool IsLastRow(const TextRow& row) {
  constexpr double kLastRow[] = {0.0, 0.0, 0.0, 1.0};
  return std::equal(
      row.fields.begin(), row.fields.end(), std::begin(kLastRow), std::end(kLastRow),
      [](std::string_view field, double value) { return ParseNumber(field) == value; });
}

Layout LayoutOf(const std::vector<TextRow>& rows, const std::string& place) {
  const auto is_whole = [](const TextRow& row) {
    const std::size_t columns = row.fields.size();
    return columns == 4 || columns == 12 || columns == 16;
  };
  const auto first = std::find_if(rows.begin(), rows.end(), is_whole);
  if (first == rows.end()) {
    throw InputError(PlaceOfLine(place, rows.front().line),
                     fmt::format("has {}, must be a row of a matrix (4) or a whole matrix "
                                 "(12 or 16)",
                                 Counted(rows.front().fields.size(), "column")));
  }
  if (first->fields.size() != 4) return {1, first->fields.size()};
  // Four lines of four when the fourth (or, with that one damaged, the eighth) is 0 0 0 1, which
  // cannot be a row of a pose; otherwise three.
  const auto ends_matrix = [&](std::size_t row) {
    return row < rows.size() && IsLastRow(rows[row]);
  };
  return {ends_matrix(3) || ends_matrix(7) || rows.size() == 4 ? 4U : 3U, 4};
}

std::optional<Pose3> ParseOne(const std::string& text, const std::string& place,
                              RowDamage& damage) {
  const auto poses = ParseMatrixPoses(text, place, damage);
  damage.RequireAllGood();
  if (poses.size() != 1) {
    throw InputError(place, fmt::format("holds {} poses, must hold one 4x4 matrix", poses.size()));
  }
  return poses.front();
}

}  // namespace

Pose3 RigidMotionOf(std::span<const double> numbers, const std::string& place) {
  RowDamage damage;
  const auto pose = PoseOf(numbers, place, damage);
  if (!pose) throw InputError("", damage.left_out().first);
  return *pose;
}

std::optional<Pose3> ParseMatrixPose(const std::string& text, const std::string& place) {
  RowDamage damage;
  return ParseOne(text, place, damage);
}

std::vector<std::optional<Pose3>> ParseMatrixPoses(const std::string& text,
                                                   const std::string& place, RowDamage& damage) {
  const std::vector<TextRow> rows = SplitRows(text);
  if (rows.empty()) return {};
  const Layout layout = LayoutOf(rows, place);
  std::vector<std::optional<Pose3>> poses;
  for (std::size_t begin = 0; begin < rows.size(); begin += layout.lines) {
    poses.emplace_back();
    damage.Try([&] {
      std::vector<double> matrix;
      const std::size_t end = std::min(begin + layout.lines, rows.size());
      for (std::size_t i = begin; i < end; ++i) {
        const std::vector<double> numbers = NumbersIn(rows[i], layout.columns, place);
        matrix.insert(matrix.end(), numbers.begin(), numbers.end());
      }
      const std::string last_place = PlaceOfLine(place, rows[end - 1].line);
      if (end - begin < layout.lines) throw InputError(last_place, "the last matrix is incomplete");
      poses.back() = PoseOf(matrix, last_place, damage);
    });
  }
  damage.RequireMostGood(text);
  return poses;
}

void RequireSomePose(const std::vector<std::optional<Pose3>>& poses, const RowDamage& damage,
                     const std::string& place) {
  const auto is_pose = [](const std::optional<Pose3>& pose) { return pose.has_value(); };
  if (std::none_of(poses.begin(), poses.end(), is_pose)) throw damage.NothingIn(place, "pose");
}

std::optional<Pose3> ReadMatrixPose(const std::string& path, Tally& left_out) {
  RowDamage damage;
  const auto pose = ParseOne(ReadTextFile(path), path, damage);
  if (!pose) left_out.Add(damage.left_out().first);
  return pose;
}

std::vector<std::optional<Pose3>> ReadMatrixPoses(const std::string& path,
                                                  std::vector<std::string>& warnings) {
  RowDamage damage;
  auto poses = ParseMatrixPoses(ReadTextFile(path), path, damage);
  RequireSomePose(poses, damage, path);
  damage.AppendTo(warnings, path);
  return poses;
}

std::string MatrixPosesText(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& stamped : trajectory) {
    const Eigen::Matrix3d rotation = stamped.world_from_camera.rotation.toRotationMatrix();
    const Eigen::Vector3d& translation = stamped.world_from_camera.translation;
    for (int row = 0; row < 3; ++row) {
      text += fmt::format("{} {} {} {}{}", rotation(row, 0), rotation(row, 1), rotation(row, 2),
                          translation[row], row == 2 ? "\n" : " ");
    }
  }
  return text;
}

}  // namespace depthgrid
