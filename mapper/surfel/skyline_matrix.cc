#include "mapper/surfel/skyline_matrix.h"

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

double Dot(const double* a, const double* b, int n) {
  return ConstVector(a, n).dot(ConstVector(b, n));
}

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<double, 4>;
constexpr Lanes kLanes;

// Unknowns and rows come in threes (a pose). The products of three rows with three rows share their
// loads.
constexpr int kBlock = 3;
// Rows that are factored together, so that of 2,000 unknowns those they meet stay in the cache.
constexpr int kTile = 12 * kBlock;
using Rows = std::array<double*, kBlock>;
using Block = std::array<std::array<double, kBlock>, kBlock>;

// dots[r][c] = a[r] . b[c] over n columns.
Block Dots(const Rows& a, const Rows& b, int n) {
  hn::Vec<Lanes> sums[kBlock][kBlock];
  for (auto& row : sums) {
    for (auto& sum : row) sum = hn::Zero(kLanes);
  }
  const int lanes = static_cast<int>(hn::Lanes(kLanes));
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    const hn::Vec<Lanes> b0 = hn::LoadU(kLanes, b[0] + i);
    const hn::Vec<Lanes> b1 = hn::LoadU(kLanes, b[1] + i);
    const hn::Vec<Lanes> b2 = hn::LoadU(kLanes, b[2] + i);
    for (std::size_t r = 0; r < kBlock; ++r) {
      const hn::Vec<Lanes> row = hn::LoadU(kLanes, a[r] + i);
      sums[r][0] = hn::MulAdd(row, b0, sums[r][0]);
      sums[r][1] = hn::MulAdd(row, b1, sums[r][1]);
      sums[r][2] = hn::MulAdd(row, b2, sums[r][2]);
    }
  }
  Block dots;
  for (std::size_t r = 0; r < kBlock; ++r) {
    for (std::size_t c = 0; c < kBlock; ++c) {
      dots[r][c] = hn::GetLane(hn::SumOfLanes(kLanes, sums[r][c]));
      for (int k = i; k < n; ++k) dots[r][c] += a[r][k] * b[c][k];
    }
  }
  return dots;
}

}  // namespace

SkylineMatrix::SkylineMatrix(std::vector<int> first) : first_(std::move(first)) {
  std::size_t total = 0;
  begin_.reserve(first_.size());
  for (int i = 0; i < size(); ++i) {
    Require(First(i) >= 0 && First(i) <= i, "a skyline row begins at or before the diagonal");
    begin_.push_back(total);
    total += static_cast<std::size_t>(i - First(i) + 1);
  }
  values_.assign(total, 0.0);
}

void SkylineMatrix::AddBlock(int row_pose, int column_pose, const Eigen::Matrix3d& block) {
  for (int row = 0; row < kBlock; ++row) {
    double* out = At(kBlock * row_pose + row, kBlock * column_pose);
    const int columns = row_pose == column_pose ? row + 1 : kBlock;
    for (int column = 0; column < columns; ++column) out[column] += block(row, column);
  }
}

void SkylineMatrix::AddProducts(int row_pose, const Eigen::Vector3d& left,
                                std::span<const PoseShare> right) {
  if (right.empty()) return;
  const int first = kBlock * right[0].pose;
  double* const a = At(kBlock * row_pose, first);
  double* const b = At(kBlock * row_pose + 1, first);
  double* const c = At(kBlock * row_pose + 2, first);
  for (const PoseShare& of : right) {
    for (int k = 0; k < kBlock; ++k) {
      const int column = kBlock * of.pose + k - first;
      a[column] += left[0] * of.share[k];
      b[column] += left[1] * of.share[k];
      c[column] += left[2] * of.share[k];
    }
  }
}

bool SkylineMatrix::IsInBlocks() const {
  if (size() % kBlock != 0) return false;
  for (int i = 0; i < size(); ++i) {
    if (First(i) != First(i - i % kBlock) || First(i) % kBlock != 0) return false;
  }
  return true;
}

bool SkylineMatrix::Factor() { return IsInBlocks() ? FactorByBlocks() : FactorByRows(); }

bool SkylineMatrix::FactorByBlocks() {
  for (int tile = 0; tile < size(); tile += kTile) {
    const int tile_end = std::min(tile + kTile, size());
    for (int column = 0; column < tile; column += kTile) {
      for (int i = tile; i < tile_end; i += kBlock) FactorLeftOfDiagonal(i, column, column + kTile);
    }
    for (int i = tile; i < tile_end; i += kBlock) {
      FactorLeftOfDiagonal(i, tile, i);
      if (!FactorDiagonal(i)) return false;
    }
  }
  return true;
}

void SkylineMatrix::FactorLeftOfDiagonal(int i, int begin, int end) {
  for (int j = std::max(begin, First(i)); j < end; j += kBlock) {
    const int k = std::max(First(i), First(j));
    const Block dots = Dots(RowsAt(i, k), RowsAt(j, k), j - k);
    const Rows diagonal = RowsAt(j, j);
    for (std::size_t r = 0; r < kBlock; ++r) {
      double* x = At(i + static_cast<int>(r), j);
      x[0] = (x[0] - dots[r][0]) / diagonal[0][0];
      x[1] = (x[1] - dots[r][1] - x[0] * diagonal[1][0]) / diagonal[1][1];
      x[2] = (x[2] - dots[r][2] - x[0] * diagonal[2][0] - x[1] * diagonal[2][1]) / diagonal[2][2];
    }
  }
}

bool SkylineMatrix::FactorDiagonal(int i) {
  const Rows rows = RowsAt(i, First(i));
  const Block dots = Dots(rows, rows, i - First(i));
  const Rows diagonal = RowsAt(i, i);
  for (std::size_t r = 0; r < kBlock; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      double value = diagonal[r][c] - dots[r][c];
      for (std::size_t k = 0; k < c; ++k) value -= diagonal[r][k] * diagonal[c][k];
      if (c < r) {
        diagonal[r][c] = value / diagonal[c][c];
      } else {
        if (!(value > 0.0)) return false;
        diagonal[r][r] = std::sqrt(value);
      }
    }
  }
  return true;
}

bool SkylineMatrix::FactorByRows() {
  for (int i = 0; i < size(); ++i) {
    const int begin = First(i);
    double* row = At(i, begin);
    for (int j = begin; j < i; ++j) {
      const int k = std::max(begin, First(j));
      const double sum = Dot(row + (k - begin), At(j, k), j - k);
      row[j - begin] = (row[j - begin] - sum) / *At(j, j);
    }
    double& diagonal = row[i - begin];
    diagonal -= Dot(row, row, i - begin);
    if (!(diagonal > 0.0)) return false;
    diagonal = std::sqrt(diagonal);
  }
  return true;
}

Eigen::VectorXd SkylineMatrix::Solve(Eigen::VectorXd b) const {
  for (int i = 0; i < size(); ++i) {
    const int begin = First(i);
    b[i] = (b[i] - Dot(At(i, begin), b.data() + begin, i - begin)) / *At(i, i);
  }
  for (int i = size() - 1; i >= 0; --i) {
    const int begin = First(i);
    b[i] /= *At(i, i);
    b.segment(begin, i - begin) -= b[i] * ConstVector(At(i, begin), i - begin);
  }
  return b;
}

Eigen::MatrixXd SkylineMatrix::SolveAll(const Eigen::MatrixXd& b) const {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  RowMajor x = b;
  for (int i = 0; i < size(); ++i) {
    const int begin = First(i);
    const ConstVector row(At(i, begin), i - begin);
    x.row(i).noalias() -= row.transpose() * x.middleRows(begin, i - begin);
    x.row(i) /= *At(i, i);
  }
  for (int i = size() - 1; i >= 0; --i) {
    const int begin = First(i);
    const ConstVector row(At(i, begin), i - begin);
    x.row(i) /= *At(i, i);
    x.middleRows(begin, i - begin).noalias() -= row * x.row(i);
  }
  return x;
}

}  // namespace depthgrid
