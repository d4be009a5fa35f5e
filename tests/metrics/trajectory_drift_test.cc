#include "eval/metrics/trajectory_drift.h"

#include <gtest/gtest.h>

#include "eval/metrics/tum_association.h"

namespace depthgrid {
namespace {

Pose3 At(double x_m, double y_m = 0.0, double yaw_rad = 0.0) { return Lift({x_m, y_m, yaw_rad}); }

// 1 m/s along x, a pose each 0.1 s; the estimate goes `scale` times as far and turns by a rate.
std::vector<PosePair> Straight(double scale, double turn_rad_per_s) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.1 * i;
    pairs.push_back({{t, At(t)}, {t, At(scale * t, 0.0, turn_rad_per_s * t)}});
  }
  return pairs;
}

TEST(Drift, HandWorked) {
  const auto second = DriftOverTime(Straight(1.02, 0.0), 1.0);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->motions, 91);
  EXPECT_NEAR(second->translation_rms_m, 0.02, 1e-12);
  EXPECT_NEAR(second->translation_mean_m, 0.02, 1e-12);
  EXPECT_NEAR(DriftOverTime(Straight(1.02, 0.0), 5.0)->translation_mean_m, 0.1, 1e-12);
  EXPECT_NEAR(DriftOverPath(Straight(1.02, 0.0), 2.0)->translation_mean_m, 0.04, 1e-12);
  EXPECT_EQ(DriftOverPath(Straight(1.02, 0.0), 2.0)->motions, 81);
  EXPECT_NEAR(DriftOverTime(Straight(1.0, 0.03), 2.0)->rotation_rms_rad, 0.06, 1e-12);
  EXPECT_FALSE(DriftOverTime(Straight(1.0, 0.0), 20.0));
  EXPECT_FALSE(DriftOverPath(Straight(1.0, 0.0), 20.0));
}

// A motion runs to the first pose that far ahead, which sparse poses have well beyond.
TEST(Drift, OfSparsePosesIsDividedByWhatTheMotionsCover) {
  std::vector<PosePair> sparse;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.7 * i;
    sparse.push_back({{t, At(0.55 * t)}, {t, At(0.57 * t)}});
  }
  const auto second = DriftOverTime(sparse, 1.0);
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->mean_over, 1.4, 1e-12);
  EXPECT_NEAR(second->translation_mean_m, 0.028, 1e-12);
  EXPECT_NEAR(second->PerUnit(), 0.02, 1e-12);
  EXPECT_NEAR(DriftOverPath(sparse, 1.0)->PerUnit(), 0.02 / 0.55, 1e-12);
}

TEST(Drift, AcrossAGapNothingIsSaid) {
  std::vector<PosePair> pairs = Straight(1.02, 0.0);
  pairs.erase(pairs.begin() + 20, pairs.begin() + 60);
  // 4.1 s are missing: motions of 1 s that would span them do not count, those of 5 s do.
  EXPECT_EQ(DriftOverTime(pairs, 1.0)->motions, 91 - 50 + 0);
  EXPECT_GT(DriftOverTime(pairs, 5.0)->motions, 0);
}

TEST(TumAssociation, EachPoseOnceNearestFirst) {
  const Trajectory reference = {{1.000, At(0)}, {1.010, At(1)}, {1.020, At(2)}, {2.0, At(3)}};
  const Trajectory estimate = {{1.009, At(10)}, {1.012, At(11)}, {1.5, At(12)}, {2.02, At(13)}};
  const auto pairs = AssociateAsTum(reference, estimate);
  // 1.010-1.009 first (1 ms); then 1.020-1.012 (8 ms), as 1.010-1.012 is taken; 1.000 is left with
  // nothing; 2.0-2.02 is not nearer than 0.02 s.
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].reference.stamp_s, 1.010);
  EXPECT_EQ(pairs[0].estimate.stamp_s, 1.009);
  EXPECT_EQ(pairs[1].reference.stamp_s, 1.020);
  EXPECT_EQ(pairs[1].estimate.stamp_s, 1.012);
  EXPECT_TRUE(AssociateAsTum(reference, {}).empty());
}

}  // namespace
}  // namespace depthgrid
