// Cholesky factorisation of a sparse symmetric matrix stored by rows, each from its first non-zero
// to the diagonal: what a trajectory in order of time gives, where most rows are short and only the
// revisits' are long (George and Liu 1981, "envelope" methods).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace depthgrid {

class SkylineMatrix {
 public:
  // first[i] is the first column of row i, at most i.
  explicit SkylineMatrix(std::vector<int> first);

  int size() const { return static_cast<int>(first_.size()); }
  // Row i: element j is Row(i)[j - First(i)], First(i) <= j <= i.
  double* Row(int i) { return values_.data() + begin_[static_cast<std::size_t>(i)]; }
  const double* Row(int i) const { return values_.data() + begin_[static_cast<std::size_t>(i)]; }
  int First(int i) const { return first_[static_cast<std::size_t>(i)]; }
  double& At(int i, int j) { return Row(i)[j - First(i)]; }
  // Replaces the lower triangle by the factor L of L L^T. False when the matrix is not positive
  // definite.
  bool Factor();
  // Solves L L^T x = b; after Factor().
  Eigen::VectorXd Solve(Eigen::VectorXd b) const;

 private:
  std::vector<int> first_;
  std::vector<std::size_t> begin_;
  std::vector<double> values_;
};

}  // namespace depthgrid
