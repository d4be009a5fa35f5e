// Both ways to keep and factor normal equations, on the same blocks.
#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "mapper/surfel/skyline_matrix.h"
#include "mapper/surfel/sparse_pose_matrix.h"

namespace depthgrid {
namespace {

struct BlockEntry {
  int row = 0, column = 0;
  Eigen::Matrix3d block;
};

// A chain of poses, some of which were where an earlier one was; added in pieces and no order.
std::vector<BlockEntry> ChainWithRevisits(int poses, RandomStream& random) {
  std::vector<BlockEntry> entries;
  const auto couple = [&](int row, int column) {
    Eigen::Matrix3d block;
    for (int k = 0; k < 9; ++k) block(k / 3, k % 3) = random.Normal();
    if (row == column)
      block = 40.0 * Eigen::Matrix3d::Identity() + block + block.transpose().eval();
    entries.push_back({row, column, block});
  };
  for (int i = poses - 1; i >= 0; --i) {
    couple(i, i);
    if (i > 0) couple(i, i - 1);
    if (i > 4 && i % 3 == 0)
      couple(i, static_cast<int>(random.Below(static_cast<std::uint64_t>(i))));
  }
  couple(2, 1);  // twice
  return entries;
}

Eigen::MatrixXd DenseOf(const std::vector<BlockEntry>& entries, int poses) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * poses, 3 * poses);
  for (const BlockEntry& e : entries) {
    dense.block<3, 3>(3 * e.row, 3 * e.column) += e.block;
    if (e.row != e.column) {
      dense.block<3, 3>(3 * e.column, 3 * e.row) += e.block.transpose();
    }
  }
  return dense;
}

std::vector<std::unique_ptr<PoseMatrix>> BothFor(int poses) {
  std::vector<std::unique_ptr<PoseMatrix>> both;
  both.push_back(
      std::make_unique<SkylineMatrix>(std::vector<int>(static_cast<std::size_t>(3 * poses), 0)));
  both.push_back(std::make_unique<SparsePoseMatrix>(poses));
  return both;
}

TEST(PoseMatrix, BothSolveWhatTheDenseMatrixSays) {
  RandomStream random(21, RandomStage::kTest);
  for (const int poses : {3, 8, 40}) {
    const std::vector<BlockEntry> entries = ChainWithRevisits(poses, random);
    Eigen::MatrixXd dense = DenseOf(entries, poses);
    dense(4, 4) += 7.0;
    Eigen::VectorXd b(3 * poses);
    for (double& value : b) value = random.Normal();
    Eigen::MatrixXd several(3 * poses, 5);
    for (double& value : several.reshaped()) value = random.Normal();
    for (const auto& matrix : BothFor(poses)) {
      ASSERT_EQ(matrix->size(), 3 * poses);
      for (const BlockEntry& e : entries) matrix->AddBlock(e.row, e.column, e.block);
      matrix->Diagonal(4) += 7.0;
      ASSERT_TRUE(matrix->Factor());
      EXPECT_LT((dense * matrix->Solve(b) - b).norm(), 1e-10);
      EXPECT_LT((dense * matrix->SolveAll(several) - several).norm(), 1e-10);
      EXPECT_EQ(matrix->SolveAll(Eigen::MatrixXd(3 * poses, 0)).cols(), 0);
    }
  }
}

TEST(PoseMatrix, BothTellWhatIsNotPositiveDefinite) {
  for (const auto& matrix : BothFor(3)) {
    for (int i = 0; i < 3; ++i) matrix->AddBlock(i, i, Eigen::Matrix3d::Identity());
    matrix->AddBlock(2, 0, 2.0 * Eigen::Matrix3d::Identity());
    EXPECT_FALSE(matrix->Factor());
  }
}

}  // namespace
}  // namespace depthgrid
