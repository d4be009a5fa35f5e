// Normal equations of very many poses that were here before: only blocks that are not zero are
// kept, and poses are eliminated in an order that keeps the factor sparse (approximate minimum
// degree, Amestoy, Davis and Duff 1996). What is seen again and again fills the rows of a
// SkylineMatrix; here cost follows the area and how often it was seen, not the length of the run
// squared.
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
  // The block of two poses, zero at first.
  Eigen::Matrix3d& BlockAt(int row_pose, int column_pose);

  bool FactorDense();
  bool FactorSparse();

  struct Factored;
  std::vector<std::vector<Entry>> rows_;  // each by column
  std::vector<Eigen::Matrix3d> blocks_;
  std::unique_ptr<Factored> factored_;
};

}  // namespace depthgrid
