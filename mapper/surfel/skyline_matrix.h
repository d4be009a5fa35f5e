// A sparse symmetric matrix stored by rows, each from its first non-zero to the diagonal, and its
// Cholesky factor, which fits in the same place (George and Liu 1981, envelope methods). Poses in
// order of time give short rows; only those of revisits are long.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

class SkylineMatrix : public PoseMatrix {
 public:
  // A zero matrix; first[i] <= i is the first stored column of row i.
  explicit SkylineMatrix(std::vector<int> first);

  int size() const override { return static_cast<int>(first_.size()); }
  int First(int row) const { return first_[static_cast<std::size_t>(row)]; }
  // Pointer to element (row, column), First(row) <= column <= row; the rest of the row follows it.
  double* At(int row, int column) {
    return values_.data() + begin_[static_cast<std::size_t>(row)] + (column - First(row));
  }
  const double* At(int row, int column) const {
    return values_.data() + begin_[static_cast<std::size_t>(row)] + (column - First(row));
  }
  // Requires that the block lies within the stored rows.
  void AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) override;
  void AddProducts(int row_pose, const Eigen::Vector3d& left,
                   std::span<const PoseShare> right) override;
  double& Diagonal(int i) override { return *At(i, i); }
  // Replaces the matrix by its lower Cholesky factor L.
  bool Factor() override;
  Eigen::VectorXd Solve(Eigen::VectorXd b) const override;
  Eigen::MatrixXd SolveAll(const Eigen::MatrixXd& b) const override;

 private:
  // Whether each three rows begin in the same column, a multiple of three.
  bool IsInBlocks() const;
  std::array<double*, 3> RowsAt(int i, int column) {
    return {At(i, column), At(i + 1, column), At(i + 2, column)};
  }
  bool FactorByBlocks();
  // The factor of rows i to i + 2, columns begin to end - 1, of which those before are there.
  void FactorLeftOfDiagonal(int i, int begin, int end);
  bool FactorDiagonal(int i);
  bool FactorByRows();

  std::vector<int> first_;
  std::vector<std::size_t> begin_;
  std::vector<double> values_;
};

}  // namespace depthgrid
