// Sparse normal equations for very many poses with revisits: only non-zero blocks are stored, and
// poses are eliminated in approximate minimum degree order (Amestoy, Davis and Duff 1996). Revisits
// fill the rows of a SkylineMatrix; here the cost grows with the area and the number of visits, not
// with the square of the run's length.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "mapper/surfel/pose_matrix.h"

namespace depthgrid {

class SparsePoseMatrix : public PoseMatrix {
 public:
  explicit SparsePoseMatrix(int poses);
  ~SparsePoseMatrix() override;

  int size() const override { return 3 * static_cast<int>(rows_.size()); }
  void AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) override;
  void AddProducts(int row_pose, const Eigen::Vector3d& left,
                   std::span<const PoseShare> right) override;
  double& Diagonal(int i) override;
  bool Factor() override;
  Eigen::VectorXd Solve(Eigen::VectorXd b) const override;
  Eigen::MatrixXd SolveAll(const Eigen::MatrixXd& b) const override;

 private:
  struct Entry {
    int column = 0;
    int block = 0;
  };
  // Where the block of two poses is in its row, at `from` or later; it is created as zero.
  std::size_t PlaceOf(int row_pose, int column_pose, std::size_t from);
  Eigen::Matrix3d& BlockAt(int row_pose, int column_pose) {
    return BlockOf(row_pose, PlaceOf(row_pose, column_pose, 0));
  }
  Eigen::Matrix3d& BlockOf(int row_pose, std::size_t place) {
    const Entry& entry = rows_[static_cast<std::size_t>(row_pose)][place];
    return blocks_[static_cast<std::size_t>(entry.block)];
  }

  bool FactorDense();
  bool FactorSparse();

  struct Factored;
  std::vector<std::vector<Entry>> rows_;  // each sorted by column
  std::vector<Eigen::Matrix3d> blocks_;
  std::unique_ptr<Factored> factored_;
};

}  // namespace depthgrid
