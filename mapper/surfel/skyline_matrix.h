// A sparse symmetric matrix stored by rows, each from its first non-zero to the diagonal, and its
// Cholesky factor, which fits in the same place (George and Liu 1981, envelope methods). Poses in
// order of time give short rows; only those of revisits are long.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace depthgrid {

class SkylineMatrix {
 public:
  // Zero; first[i] <= i is the first column of row i.
  explicit SkylineMatrix(std::vector<int> first);

  int size() const { return static_cast<int>(first_.size()); }
  int First(int row) const { return first_[static_cast<std::size_t>(row)]; }
  // Element (row, column), First(row) <= column <= row, and what lies right of it in the row.
  double* At(int row, int column) {
    return values_.data() + begin_[static_cast<std::size_t>(row)] + (column - First(row));
  }
  const double* At(int row, int column) const {
    return values_.data() + begin_[static_cast<std::size_t>(row)] + (column - First(row));
  }
  // Becomes the lower factor L of L L^T. False when the matrix is not positive definite.
  bool Factor();
  // Solves L L^T x = b, after Factor().
  Eigen::VectorXd Solve(Eigen::VectorXd b) const;

 private:
  // Whether rows come in threes that begin in one column, at a multiple of three.
  bool IsInBlocks() const;
  bool FactorByBlocks();
  bool FactorByRows();

  std::vector<int> first_;
  std::vector<std::size_t> begin_;
  std::vector<double> values_;
};

}  // namespace depthgrid
