#include "mapper/surfel/sparse_pose_matrix.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <utility>

namespace depthgrid {

struct SparsePoseMatrix::Factored {
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
};

SparsePoseMatrix::SparsePoseMatrix(int poses) : rows_(static_cast<std::size_t>(poses)) {}
SparsePoseMatrix::~SparsePoseMatrix() = default;

Eigen::Matrix3d& SparsePoseMatrix::BlockAt(int row_pose, int column_pose) {
  std::vector<Entry>& row = rows_[static_cast<std::size_t>(row_pose)];
  auto place = std::lower_bound(row.begin(), row.end(), column_pose,
                                [](const Entry& e, int column) { return e.column < column; });
  if (place == row.end() || place->column != column_pose) {
    place = row.insert(place, {column_pose, static_cast<int>(blocks_.size())});
    blocks_.emplace_back(Eigen::Matrix3d::Zero());
  }
  return blocks_[static_cast<std::size_t>(place->block)];
}

void SparsePoseMatrix::AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) {
  BlockAt(row_pose, column_pose) += block;
}

double& SparsePoseMatrix::Diagonal(int i) { return BlockAt(i / 3, i / 3)(i % 3, i % 3); }

bool SparsePoseMatrix::Factor() {
  // The lower triangle by columns is the upper one by rows: each block row becomes three columns.
  Eigen::SparseMatrix<double> upper(size(), size());
  std::vector<int> entries(static_cast<std::size_t>(size()));
  for (int i = 0; i < size(); ++i) {
    entries[static_cast<std::size_t>(i)] =
        3 * static_cast<int>(rows_[static_cast<std::size_t>(i / 3)].size());
  }
  upper.reserve(entries);
  for (int i = 0; i < size(); ++i) {
    for (const Entry& entry : rows_[static_cast<std::size_t>(i / 3)]) {
      const Eigen::Matrix3d& block = blocks_[static_cast<std::size_t>(entry.block)];
      for (int k = 0; k < 3; ++k) {
        if (3 * entry.column + k <= i) upper.insert(3 * entry.column + k, i) = block(i % 3, k);
      }
    }
  }
  factored_ = std::make_unique<Factored>();
  factored_->solver.compute(upper.transpose());
  return factored_->solver.info() == Eigen::Success;
}

Eigen::VectorXd SparsePoseMatrix::Solve(Eigen::VectorXd b) const {
  return factored_->solver.solve(b);
}

}  // namespace depthgrid
