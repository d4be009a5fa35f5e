#include "mapper/surfel/sparse_pose_matrix.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>

namespace depthgrid {

struct SparsePoseMatrix::Factored {
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> sparse;
  Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> dense;
  bool is_dense = false;
};

// Share of non-zero blocks above which a dense factor is used (a wide view couples most poses). At
// this share the sparse factor is half full (56 % at twice the share) and the dense one four times
// as fast.
constexpr double kDenseShare = 0.125;
// Unknowns of the largest dense matrix: 430 MB.
constexpr int kMostDense = 7500;

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
  factored_ = std::make_unique<Factored>();
  const double all =
      0.5 * static_cast<double>(rows_.size()) * static_cast<double>(rows_.size() + 1);
  factored_->is_dense =
      size() <= kMostDense && static_cast<double>(blocks_.size()) > kDenseShare * all;
  return factored_->is_dense ? FactorDense() : FactorSparse();
}

bool SparsePoseMatrix::FactorDense() {
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    for (const Entry& entry : rows_[row]) {
      lower.block<3, 3>(3 * static_cast<Eigen::Index>(row), 3 * entry.column) =
          blocks_[static_cast<std::size_t>(entry.block)];
    }
  }
  factored_->dense.compute(lower);
  return factored_->dense.info() == Eigen::Success;
}

bool SparsePoseMatrix::FactorSparse() {
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
  factored_->sparse.compute(upper.transpose());
  return factored_->sparse.info() == Eigen::Success;
}

Eigen::VectorXd SparsePoseMatrix::Solve(Eigen::VectorXd b) const {
  if (factored_->is_dense) return factored_->dense.solve(b);
  return factored_->sparse.solve(b);
}

Eigen::MatrixXd SparsePoseMatrix::SolveAll(const Eigen::MatrixXd& b) const {
  if (b.cols() == 0) return b;  // Eigen's dense solver asks for a first column
  if (factored_->is_dense) return factored_->dense.solve(b);
  return factored_->sparse.solve(b);
}

}  // namespace depthgrid
