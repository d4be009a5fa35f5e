#include "mapper/core/normal_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

TEST(NormalBlock, IsBoxMullerOnTheWordsOfRandom123) {
  const std::uint64_t seed = 0x123456789ABCDEF0;
  NormalBlock block;
  int cases = 0;
  for (const std::uint32_t first : {0U, 7U, 300000U, 0xFFFFFF00U}) {
    FillNormals(seed, RandomStage::kTest, 42, first, block);
    for (std::uint32_t i = 0; i < kNormalBlockItems; ++i) {
      const auto words = RandomWords(seed, RandomStage::kTest, 42, first + i);
      for (std::size_t pair = 0; pair < 4; pair += 2) {
        const double uniform = ((words[pair] >> 9) + 0.5) * 0x1.0p-23;
        const double radius = std::sqrt(-2.0 * std::log(uniform));
        const double angle =
            0.5 * kPi * ((((words[pair + 1] >> 8) & 0x3FFFFF) + 0.5) * 0x1.0p-22 - 0.5);
        double x = radius * std::cos(angle), y = radius * std::sin(angle);
        if ((words[pair + 1] >> 30 & 1U) != 0) std::swap(x, y);
        const double sign = (words[pair + 1] >> 31) != 0 ? -1.0 : 1.0;
        ASSERT_NEAR(block.normals[pair][i], sign * x, 3e-6);
        ASSERT_NEAR(block.normals[pair + 1][i], sign * y, 3e-6);
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 4 * 2 * kNormalBlockItems);
}

TEST(NormalBlock, DrawsBelongToItemsNotToBlocks) {
  NormalBlock from_zero, from_ten;
  FillNormals(1, RandomStage::kTest, 0, 0, from_zero);
  FillNormals(1, RandomStage::kTest, 0, 10, from_ten);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 10; i < kNormalBlockItems; ++i) {
      EXPECT_EQ(from_zero.normals[k][i], from_ten.normals[k][i - 10]);
    }
  }
}

TEST(NormalBlock, IsStandardNormal) {
  constexpr int kBlocks = 4000;
  constexpr double kCount = static_cast<double>(kBlocks) * kNormalBlockItems;  // 1.02 million
  NormalBlock block;
  std::array<std::vector<double>, 4> draws;
  double cross = 0.0;
  for (std::uint32_t b = 0; b < kBlocks; ++b) {
    FillNormals(2, RandomStage::kTest, 0, b * kNormalBlockItems, block);
    for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
      for (std::size_t k = 0; k < 4; ++k) draws[k].push_back(block.normals[k][i]);
      cross += double{block.normals[0][i]} * block.normals[1][i];
    }
  }
  EXPECT_NEAR(cross / kCount, 0.0, 4 / std::sqrt(kCount));
  for (auto& sample : draws) {
    double sum = 0.0, squares = 0.0;
    for (const double x : sample) {
      sum += x;
      squares += x * x;
    }
    EXPECT_NEAR(sum / kCount, 0.0, 4 / std::sqrt(kCount));
    EXPECT_NEAR(squares / kCount, 1.0, 4 * std::sqrt(2.0 / kCount));
    // Kolmogorov-Smirnov at the 0.1 % level.
    std::sort(sample.begin(), sample.end());
    double largest = 0.0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
      const double below = 0.5 * std::erfc(-sample[i] / std::sqrt(2.0));
      largest = std::max(largest, std::abs(below - (static_cast<double>(i) + 0.5) / kCount));
    }
    EXPECT_LT(largest, 1.95 / std::sqrt(kCount));
  }
}

}  // namespace
}  // namespace depthgrid
