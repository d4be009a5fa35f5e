#include "mapper/io/held_gaps.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// Six frames a second apart of which those from 1 to 2 are held; the next is at `next_m`.
MendedPoses Mended(double next_m, int next_epoch = 0, double next_s = 3.0) {
  std::vector<TimedPose> frames;
  for (int i = 0; i < 3; ++i) frames.push_back({1.0 * i, Lift({1.0, 0.0, 0.0}), 0});
  for (int i = 0; i < 3; ++i) frames.push_back({next_s + i, Lift({next_m, 0.0, 0.0}), next_epoch});
  return MendHeld(frames, {false, true, true, false, false, false});
}

TEST(HeldGaps, AreInterpolatedByStamp) {
  const MendedPoses mended = Mended(2.5);
  ASSERT_EQ(mended.gaps.size(), 1U);
  EXPECT_TRUE(mended.gaps[0].is_interpolated);
  EXPECT_NEAR(mended.poses[1]->translation.x(), 1.5, 1e-12);
  EXPECT_NEAR(mended.poses[2]->translation.x(), 2.0, 1e-12);
  EXPECT_EQ(mended.poses[3]->translation.x(), 2.5);
}

TEST(HeldGaps, HaveNoPoseWhereTheWayIsNotKnown) {
  for (const MendedPoses& mended :
       {Mended(1.0), Mended(2.5, 1), Mended(2.5, 0, 3.5), Mended(7.5)}) {
    EXPECT_TRUE(mended.poses[0]);
    EXPECT_FALSE(mended.poses[1]);
    EXPECT_FALSE(mended.poses[2]);
    EXPECT_TRUE(mended.poses[3]);
    EXPECT_FALSE(mended.gaps[0].is_interpolated);
  }
  const MendedPoses at_the_ends = MendHeld(std::vector<TimedPose>(3), {true, false, true});
  EXPECT_EQ(at_the_ends.gaps.size(), 2U);
}

TEST(HeldGaps, AreCountedInThePart) {
  const std::vector<HeldGap> gaps{{1, 4, true}, {6, 9, false}, {11, 12, true}};
  const HeldCount count = CountHeld(gaps, {2, 8});
  EXPECT_EQ(count.first, 2U);
  EXPECT_EQ(count.interpolated, 2U);
  EXPECT_EQ(count.lost, 2U);
  EXPECT_FALSE(CountHeld(gaps, {9, 11}).first);
}

}  // namespace
}  // namespace depthgrid
