// Sparse normal equations for very many poses with revisits: only non-zero blocks are stored, and
// poses are eliminated in approximate minimum degree order (Amestoy, Davis and Duff 1996). Revisits
// fill the rows of a SkylineMatrix; here the cost grows with the area and the number of visits, not
// with the square of the run's length.
#pragma once

#include <memory>
#include <vector>

#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

class SparsePoseMatrix : public PoseMatrix {
 public:
  explicit SparsePoseMatrix(int poses);
  ~SparsePoseMatrix() override;

  int size() const override { return 3 * static_cast<int>(rows_.size()); }
  void AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) override;
  double& Diagonal(int i) override;
  bool Factor() override;
  Eigen::VectorXd Solve(Eigen::VectorXd b) const override;
  Eigen::MatrixXd SolveAll(const Eigen::MatrixXd& b) const override;

 private:
  struct Entry {
    int column = 0;
    int block = 0;
  };
  // The block of two poses, created as zero.
  Eigen::Matrix3d& BlockAt(int row_pose, int column_pose);

  bool FactorDense();
  bool FactorSparse();

  struct Factored;
  std::vector<std::vector<Entry>> rows_;  // each sorted by column
  std::vector<Eigen::Matrix3d> blocks_;
  std::unique_ptr<Factored> factored_;
};

}  // namespace depthgrid
