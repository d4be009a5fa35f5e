#include "mapper/surfel/sparse_pose_matrix.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <optional>
#include <utility>

#include "mapper/surfel/skyline_matrix.h"

namespace depthgrid {

struct SparsePoseMatrix::Factored {
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> sparse;
  std::optional<SkylineMatrix> dense;
};

// Share of non-zero blocks above which a dense factor is used (a wide view couples most poses). At
// this share the sparse factor is a fifth to a half full, and the dense one as fast or eight times
// faster; far below it is slower.
constexpr double kDenseShare = 0.125;
// Unknowns of the largest dense matrix: 400 MB.
constexpr int kMostDense = 10000;

SparsePoseMatrix::SparsePoseMatrix(int poses) : rows_(static_cast<std::size_t>(poses)) {}
SparsePoseMatrix::~SparsePoseMatrix() = default;

std::size_t SparsePoseMatrix::PlaceOf(int row_pose, int column_pose, std::size_t from) {
  std::vector<Entry>& row = rows_[static_cast<std::size_t>(row_pose)];
  if (from < row.size() && row[from].column == column_pose) return from;
  auto place =
      std::lower_bound(row.begin() + static_cast<std::ptrdiff_t>(from), row.end(), column_pose,
                       [](const Entry& e, int column) { return e.column < column; });
  if (place == row.end() || place->column != column_pose) {
    place = row.insert(place, {column_pose, static_cast<int>(blocks_.size())});
    blocks_.emplace_back(Eigen::Matrix3d::Zero());
  }
  return static_cast<std::size_t>(place - row.begin());
}

void SparsePoseMatrix::AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) {
  BlockAt(row_pose, column_pose) += block;
}

void SparsePoseMatrix::AddProducts(int row_pose, const Eigen::Vector3d& left,
                                   std::span<const PoseShare> right) {
  std::size_t next = 0;
  for (const PoseShare& r : right) {
    const std::size_t place = PlaceOf(row_pose, r.pose, next);
    BlockOf(row_pose, place).noalias() += left * r.share.transpose();
    next = place + 1;
  }
}

double& SparsePoseMatrix::Diagonal(int i) { return BlockAt(i / 3, i / 3)(i % 3, i % 3); }

bool SparsePoseMatrix::Factor() {
  factored_ = std::make_unique<Factored>();
  const double all =
      0.5 * static_cast<double>(rows_.size()) * static_cast<double>(rows_.size() + 1);
  const bool is_dense =
      size() <= kMostDense && static_cast<double>(blocks_.size()) > kDenseShare * all;
  return is_dense ? FactorDense() : FactorSparse();
}

bool SparsePoseMatrix::FactorDense() {
  SkylineMatrix& dense =
      factored_->dense.emplace(std::vector<int>(static_cast<std::size_t>(size())));
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    for (const Entry& entry : rows_[row]) {
      dense.AddBlock(static_cast<int>(row), entry.column,
                     blocks_[static_cast<std::size_t>(entry.block)]);
    }
  }
  return dense.Factor();
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
  if (factored_->dense) return factored_->dense->Solve(std::move(b));
  return factored_->sparse.solve(b);
}

Eigen::MatrixXd SparsePoseMatrix::SolveAll(const Eigen::MatrixXd& b) const {
  if (factored_->dense) return factored_->dense->SolveAll(b);
  return factored_->sparse.solve(b);
}

}  // namespace depthgrid
