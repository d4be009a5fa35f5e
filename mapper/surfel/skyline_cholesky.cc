#include "mapper/surfel/skyline_cholesky.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

double Dot(const double* a, const double* b, int n) {
  return Eigen::Map<const Eigen::VectorXd>(a, n).dot(Eigen::Map<const Eigen::VectorXd>(b, n));
}

}  // namespace

SkylineMatrix::SkylineMatrix(std::vector<int> first) : first_(std::move(first)) {
  std::size_t total = 0;
  for (int i = 0; i < size(); ++i) {
    Require(First(i) >= 0 && First(i) <= i, "a skyline row begins at or before the diagonal");
    begin_.push_back(total);
    total += static_cast<std::size_t>(i - First(i) + 1);
  }
  values_.assign(total, 0.0);
}

bool SkylineMatrix::Factor() {
  for (int i = 0; i < size(); ++i) {
    double* row = Row(i);
    const int begin = First(i);
    for (int j = begin; j < i; ++j) {
      const double* other = Row(j);
      const int k = std::max(begin, First(j));
      const double sum = Dot(row + (k - begin), other + (k - First(j)), j - k);
      row[j - begin] = (row[j - begin] - sum) / other[j - First(j)];
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
    b[i] = (b[i] - Dot(Row(i), b.data() + begin, i - begin)) / Row(i)[i - begin];
  }
  for (int i = size() - 1; i >= 0; --i) {
    const int begin = First(i);
    b[i] /= Row(i)[i - begin];
    Eigen::Map<Eigen::VectorXd>(b.data() + begin, i - begin) -=
        b[i] * Eigen::Map<const Eigen::VectorXd>(Row(i), i - begin);
  }
  return b;
}

}  // namespace depthgrid
