// The symmetric matrix of normal equations whose unknowns are the small motions of poses, three
// each. Two implementations: skyline (skyline_matrix.h), and sparse with fill-reducing order
// (sparse_pose_matrix.h).
#pragma once

#include <Eigen/Core>
#include <span>

namespace depthgrid {

// The part of a row vector that belongs to one pose.
struct PoseShare {
  int pose = 0;
  Eigen::Vector3d share = Eigen::Vector3d::Zero();
};

class PoseMatrix {
 public:
  virtual ~PoseMatrix() = default;

  virtual int size() const = 0;
  // Adds to the 3x3 block of two poses, row >= column; of diagonal blocks only the lower triangle
  // is used.
  virtual void AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) = 0;
  // Adds left right^T to the blocks of `row_pose` and the poses of `right`, which are sorted and
  // precede it.
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
  // The same for several b, one per column, reading the factor only once.
  virtual Eigen::MatrixXd SolveAll(const Eigen::MatrixXd& b) const = 0;
};

}  // namespace depthgrid
