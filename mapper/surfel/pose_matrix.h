// The symmetric matrix of normal equations whose unknowns are the small motions of poses, three
// each. Two ways to keep and factor it: by rows from their first non-zero (skyline_matrix.h), and
// sparse with poses in an order of its own (sparse_pose_matrix.h).
#pragma once

#include <Eigen/Core>
#include <span>

namespace depthgrid {

// A part of a row vector: what belongs to one pose.
struct PoseShare {
  int pose = 0;
  Eigen::Vector3d share = Eigen::Vector3d::Zero();
};

class PoseMatrix {
 public:
  virtual ~PoseMatrix() = default;

  virtual int size() const = 0;
  // Adds to the 3x3 block of two poses, row >= column; of a pose and itself the lower triangle
  // counts.
  virtual void AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) = 0;
  // Adds left right^T to the blocks of `row_pose` and the poses of `right`, which come in order
  // and before it.
  virtual void AddProducts(int row_pose, const Eigen::Vector3d& left,
                           std::span<const PoseShare> right) {
    for (const PoseShare& r : right) {
      AddBlock(row_pose, r.pose, left * r.share.transpose());
    }
  }
  virtual double& Diagonal(int i) = 0;
  // False when the matrix is not positive definite. Nothing may be added afterwards.
  virtual bool Factor() = 0;
  // x of A x = b, after Factor().
  virtual Eigen::VectorXd Solve(Eigen::VectorXd b) const = 0;
  // The same of several b, one a column; all at once read the factor once.
  virtual Eigen::MatrixXd SolveAll(const Eigen::MatrixXd& b) const = 0;
};

}  // namespace depthgrid
