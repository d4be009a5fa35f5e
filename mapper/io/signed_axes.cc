#include "mapper/io/signed_axes.h"

#include <algorithm>
#include <array>

namespace depthgrid {
namespace {

// The number of axes that are changed.
int Changes(const Eigen::Matrix3d& axes) {
  return static_cast<int>((axes.diagonal().array() != 1.0).count());
}

}  // namespace

std::vector<Eigen::Matrix3d> AllSignedAxes() {
  std::vector<Eigen::Matrix3d> all;
  std::array<int, 3> of = {0, 1, 2};
  do {
    for (int negative = 0; negative < 8; ++negative) {  // one bit per axis
      Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row) {
        axes(row, of[static_cast<std::size_t>(row)]) = (negative >> row) % 2 == 0 ? 1.0 : -1.0;
      }
      all.push_back(axes);
    }
  } while (std::next_permutation(of.begin(), of.end()));
  std::stable_sort(all.begin(), all.end(), [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return Changes(a) < Changes(b);
  });
  return all;
}

}  // namespace depthgrid
