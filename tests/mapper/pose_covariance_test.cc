#include "mapper/surfel/pose_covariance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mapper/fuse/fusion.h"
#include "mapper/surfel/group_links.h"
#include "mapper/surfel/skyline_matrix.h"
#include "mapper/surfel/sparse_pose_matrix.h"

namespace depthgrid {
namespace {

constexpr int kGroups = 5;
const Eigen::Vector3d kLinkSigma(0.02, 0.01, 0.005);

// The first is held; each link adds its noise, in axes of its second group.
std::vector<Pose2> Bend() {
  std::vector<Pose2> map_from_group = {{1.0, 2.0, 0.3}};
  for (int g = 1; g < kGroups; ++g) {
    map_from_group.push_back(map_from_group.back() * Pose2{0.5, 0.1, 0.4});
  }
  return map_from_group;
}

void AddChain(const std::vector<Pose2>& map_from_group, PoseMatrix& h) {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(h.size());
  for (int second = 1; second < kGroups; ++second) {
    const auto s = static_cast<std::size_t>(second);
    AddLink({second - 1, second, Between(map_from_group[s - 1], map_from_group[s]), kLinkSigma},
            map_from_group, h, g);
  }
  for (int i = 0; i < 3; ++i) h.Diagonal(i) += 1e12;
  ASSERT_TRUE(h.Factor());
}

void ExpectSumsOfNoise(const PoseMatrix& factored, const std::vector<Pose2>& map_from_group) {
  const std::vector<int> groups = {1, 4, 3, 4};  // in any order, and twice
  const Eigen::MatrixXd covariance = PoseCovariance(factored, map_from_group, groups);
  ASSERT_EQ(covariance.rows(), 12);
  ASSERT_EQ(covariance.cols(), 12);
  for (std::size_t a = 0; a < groups.size(); ++a) {
    for (std::size_t b = 0; b < groups.size(); ++b) {
      // What two groups have in common is the noise up to the earlier one.
      Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
      for (int g = 1; g <= std::min(groups[a], groups[b]); ++g) {
        const Eigen::Matrix3d map_axes = AdjointOf(map_from_group[static_cast<std::size_t>(g)]);
        expected += map_axes * Squared(kLinkSigma) * map_axes.transpose();
      }
      const Eigen::Matrix3d block = covariance.block<3, 3>(3 * static_cast<Eigen::Index>(a),
                                                           3 * static_cast<Eigen::Index>(b));
      EXPECT_TRUE(block.isApprox(expected, 1e-6)) << a << " " << b << "\n" << block;
    }
  }
}

TEST(PoseCovariance, IsTheNoiseOfTheWayThere) {
  const std::vector<Pose2> map_from_group = Bend();
  std::vector<int> first;
  for (int g = 0; g < kGroups; ++g) first.insert(first.end(), 3, 3 * std::max(g - 1, 0));
  SkylineMatrix rows(first);
  AddChain(map_from_group, rows);
  ExpectSumsOfNoise(rows, map_from_group);
  SparsePoseMatrix sparse(kGroups);
  AddChain(map_from_group, sparse);
  ExpectSumsOfNoise(sparse, map_from_group);
}

TEST(PoseCovariance, OfNothingIsEmpty) {
  SkylineMatrix rows({0, 0, 0});
  for (int i = 0; i < 3; ++i) rows.Diagonal(i) = 1.0;
  ASSERT_TRUE(rows.Factor());
  EXPECT_EQ(PoseCovariance(rows, {Pose2()}, {}).size(), 0);
}

}  // namespace
}  // namespace depthgrid
