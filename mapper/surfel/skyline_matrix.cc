#include "mapper/surfel/skyline_matrix.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

double Dot(const double* a, const double* b, int n) {
  return ConstVector(a, n).dot(ConstVector(b, n));
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

bool SkylineMatrix::Factor() {
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

}  // namespace depthgrid
