#include "eval/metrics/association.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

Trajectory At(const std::vector<double>& stamps_s) {
  Trajectory trajectory;
  for (const double stamp_s : stamps_s) trajectory.push_back({stamp_s, {}});
  return trajectory;
}

std::vector<std::pair<double, double>> Stamps(const std::vector<PosePair>& pairs) {
  std::vector<std::pair<double, double>> stamps;
  for (const auto& pair : pairs) stamps.emplace_back(pair.reference.stamp_s, pair.estimate.stamp_s);
  return stamps;
}

using Expected = std::vector<std::pair<double, double>>;

TEST(Associate, TakesTheNearestWithinTheLimit) {
  EXPECT_EQ(Stamps(Associate(At({0, 1, 2, 3}), At({0.005, 1.5, 2.99}), 0.011)),
            (Expected{{0, 0.005}, {3, 2.99}}));
}

TEST(Associate, FirstOnTies) {
  EXPECT_EQ(Stamps(Associate(At({0, 1, 2}), At({0.5}), 1.0)), (Expected{{0, 0.5}}));
}

TEST(Associate, TheShorterTrajectoryChoosesSoALongerPoseMayServeTwice) {
  EXPECT_EQ(Stamps(Associate(At({1, 1.25}), At({0, 1.125, 9}), 1.0)),
            (Expected{{1, 1.125}, {1.25, 1.125}}));
  // Of equal length: the estimate chooses.
  EXPECT_EQ(Stamps(Associate(At({0, 1}), At({0.9, 1.1}), 0.5)), (Expected{{1, 0.9}, {1, 1.1}}));
}

TEST(Associate, NothingInCommon) {
  EXPECT_TRUE(Associate(At({0, 1}), At({5, 6})).empty());
  EXPECT_TRUE(Associate({}, At({5, 6})).empty());
  EXPECT_TRUE(Associate(At({5, 6}), {}).empty());
}

}  // namespace
}  // namespace depthgrid
