#include "eval/metrics/trajectory_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/metrics/alignment.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

Pose3 RandomPose(RandomStream& random, double scale) {
  Eigen::Vector3d axis(random.Normal(), random.Normal(), random.Normal());
  axis.normalize();
  const double angle_rad = random.Uniform(-1.0, 1.0) * std::min(scale, 3.0);
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)),
          {random.Uniform(-scale, scale), random.Uniform(-scale, scale),
           random.Uniform(-scale, scale)}};
}

Trajectory RandomTrajectory(RandomStream& random, int poses) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) trajectory.push_back({i / 30.0, RandomPose(random, 3.0)});
  return trajectory;
}

Trajectory Moved(const Trajectory& trajectory, const Pose3& pose, double scale = 1.0) {
  Trajectory moved = trajectory;
  for (auto& stamped : moved) {
    stamped.world_from_camera.translation *= scale;
    stamped.world_from_camera = pose * stamped.world_from_camera;
  }
  return moved;
}

Trajectory Positions(const std::vector<Eigen::Vector3d>& positions) {
  Trajectory trajectory;
  for (const auto& p : positions) {
    trajectory.push_back(
        {static_cast<double>(trajectory.size()), {Eigen::Quaterniond::Identity(), p}});
  }
  return trajectory;
}

TEST(Statistics, ByHand) {
  const Statistics s = Summarise({4.0, 1.0, 3.0, 0.0});
  EXPECT_EQ(s.count, 4);
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_DOUBLE_EQ(s.median, 2.0);
  EXPECT_DOUBLE_EQ(s.sse, 26.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(6.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(2.5));
  EXPECT_EQ(s.min, 0.0);
  EXPECT_EQ(s.max, 4.0);
  EXPECT_EQ(Summarise({7.0}).median, 7.0);
}

TEST(Statistics, PercentileInterpolatesLinearly) {
  EXPECT_DOUBLE_EQ(Percentile({10, 20, 30, 40, 50}, 0.95), 48.0);
  EXPECT_DOUBLE_EQ(Percentile({50, 10}, 1.0), 50.0);
  EXPECT_DOUBLE_EQ(Percentile({3}, 0.95), 3.0);
}

// A square walked by the reference; the estimate is 3-4-5 off at one corner of four.
TEST(Ape, UnalignedByHand) {
  const Trajectory reference = Positions({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const Trajectory estimate = Positions({{0, 0, 0}, {1, 0, 0}, {4, 5, 12}, {0, 1, 0}});
  const auto score = ScoreTrajectory(reference, estimate);
  ASSERT_TRUE(score);
  EXPECT_DOUBLE_EQ(score->xy_unaligned.mean, 5.0 / 4);
  EXPECT_DOUBLE_EQ(score->xy_unaligned.rmse, 2.5);
  EXPECT_DOUBLE_EQ(score->xyz_unaligned.mean, 13.0 / 4);
  EXPECT_DOUBLE_EQ(score->reference_path_m, 3.0);
  EXPECT_EQ(score->matched_poses, 4);
}

TEST(Ape, RotationAngleByHand) {
  Trajectory reference = Positions({{0, 0, 0}});
  Trajectory estimate = reference;
  estimate[0].world_from_camera.rotation =
      Eigen::AngleAxisd(0.25, Eigen::Vector3d(1, 2, 2).normalized());
  EXPECT_NEAR(RotationErrors(Associate(reference, estimate))[0], 0.25, 1e-15);
  // The same rotation in the quaternion's other sign.
  estimate[0].world_from_camera.rotation.coeffs() *= -1.0;
  EXPECT_NEAR(RotationErrors(Associate(reference, estimate))[0], 0.25, 1e-15);
}

// Seen level, a camera that nods by 0.3 rad and errs by 0.1 rad in heading is 0.1 rad off.
TEST(Ape, HeadingIsThatOfTheBasesWhateverTheTilt) {
  Trajectory truth, estimate;
  for (int i = 0; i < 4; ++i) {
    const Pose2 base{1.0 * i, 0.2 * i * i, 3.1};
    const Eigen::Quaterniond nod(Eigen::AngleAxisd(i == 2 ? 0.3 : 0.0, Eigen::Vector3d::UnitX()));
    truth.push_back({1.0 * i, CameraOf(base, 1.0)});
    // Across the seam of angles at pi.
    estimate.push_back({1.0 * i, CameraOf({base.x_m, base.y_m, WrapAngle(3.2)}, 1.0)});
    estimate.back().world_from_camera.rotation *= nod;
  }
  const auto score = ScoreTrajectory(truth, estimate);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->heading_unaligned.min, 0.1, 1e-12);
  EXPECT_NEAR(score->heading_unaligned.max, 0.1, 1e-12);
  EXPECT_NEAR(score->rotation_unaligned.min, 0.1, 1e-12);
  EXPECT_GT(score->rotation_unaligned.max, 0.3);
  ASSERT_TRUE(score->heading_se2);  // the positions are right, so it turns nothing
  EXPECT_NEAR(score->heading_se2->mean, 0.1, 1e-9);
}

TEST(Alignment, UndoesTheTransformItCanExpress) {
  RandomStream random(4, RandomStage::kTest);
  int cases = 0;
  for (int i = 0; i < 50; ++i, ++cases) {
    const Trajectory reference = RandomTrajectory(random, 20);
    const Pose3 shift = RandomPose(random, 3.0);
    const double yaw_rad = random.Uniform(-3.0, 3.0);
    const double scale = random.Uniform(0.5, 2.0);
    const auto spatial = ScoreTrajectory(reference, Moved(reference, shift));
    EXPECT_LT(spatial->xyz_origin.max, 1e-12);
    EXPECT_LT(spatial->xyz_se3->max, 1e-12);
    EXPECT_LT(spatial->rotation_se3->max, 1e-7);
    const auto scaled = ScoreTrajectory(reference, Moved(reference, shift, scale));
    EXPECT_LT(scaled->xyz_sim3->max, 1e-12);
    EXPECT_NEAR(*scaled->sim3_scale, 1.0 / scale, 1e-12);
    const auto planar = ScoreTrajectory(reference, Moved(reference, Lift({1, -2, yaw_rad})));
    EXPECT_LT(planar->xy_se2->max, 1e-12);
    EXPECT_LT(planar->xy_origin.max, 1e-12);
  }
  EXPECT_EQ(cases, 50);
}

// No rigid transform near the fitted one does better: the fit is at a minimum, and a better
// expressive class never fits worse.
TEST(Alignment, IsTheLeastSquaresOptimum) {
  RandomStream random(5, RandomStage::kTest);
  int cases = 0;
  for (int i = 0; i < 20; ++i) {
    const Trajectory reference = RandomTrajectory(random, 15);
    const auto pairs = Associate(reference, RandomTrajectory(random, 15));
    const auto se3 = *Align(pairs, Alignment::kSe3);
    const auto se2 = *Align(pairs, Alignment::kSe2);
    const auto sse_xyz = [&](const Similarity& t) {
      return Summarise(TranslationErrorsXyz(Aligned(pairs, t))).sse;
    };
    const auto sse_xy = [&](const Similarity& t) {
      return Summarise(TranslationErrorsXy(Aligned(pairs, t))).sse;
    };
    EXPECT_LE(sse_xyz(*Align(pairs, Alignment::kSim3)), sse_xyz(se3) + 1e-9);
    for (int j = 0; j < 20; ++j, ++cases) {
      const Pose3 nudge = RandomPose(random, 1e-3);
      EXPECT_LE(sse_xyz(se3), sse_xyz({nudge * se3.reference_from_estimate, 1.0}));
      const Pose2 planar{random.Uniform(-1e-3, 1e-3), random.Uniform(-1e-3, 1e-3),
                         random.Uniform(-1e-3, 1e-3)};
      EXPECT_LE(sse_xy(se2), sse_xy({Lift(planar) * se2.reference_from_estimate, 1.0}));
    }
  }
  EXPECT_EQ(cases, 400);
}

TEST(Alignment, MirroredPointsStillGetARotation) {
  const Trajectory reference = Positions({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}});
  Trajectory mirrored = reference;
  for (auto& pose : mirrored) pose.world_from_camera.translation.x() *= -1.0;
  const auto transform = Align(Associate(reference, mirrored), Alignment::kSe3);
  ASSERT_TRUE(transform);
  EXPECT_NEAR(transform->reference_from_estimate.rotation.toRotationMatrix().determinant(), 1.0,
              1e-12);
}

TEST(Alignment, DegeneratePositionsHaveNone) {
  const Trajectory line = Positions({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const auto on_line = ScoreTrajectory(line, line);
  EXPECT_FALSE(on_line->xyz_se3);
  EXPECT_TRUE(on_line->xy_se2);
  const Trajectory still = Positions({{1, 1, 1}, {1, 1, 1}});
  EXPECT_FALSE(ScoreTrajectory(still, still)->xy_se2);
  EXPECT_FALSE(ScoreTrajectory(line, {}));
}

TEST(Rpe, ByHand) {
  // The estimate goes 1.1 m where the reference goes 1 m, twice, then agrees.
  const Trajectory reference = Positions({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  const Trajectory estimate = Positions({{0, 0, 0}, {1.1, 0, 0}, {2.2, 0, 0}, {3.2, 0, 0}});
  const auto pairs = Associate(reference, estimate);
  const auto one = ErrorsOf(pairs, StepsOfFrames(pairs.size(), 1));
  ASSERT_EQ(one.translation_m.size(), 3U);
  EXPECT_NEAR(one.translation_m[0], 0.1, 1e-15);
  EXPECT_NEAR(one.translation_m[1], 0.1, 1e-15);
  EXPECT_NEAR(one.translation_m[2], 0.0, 1e-15);
  const auto two = StepsOfFrames(pairs.size(), 2);
  ASSERT_EQ(two.size(), 1U);  // 0 to 2; 4 would be past the end
  EXPECT_EQ(two[0].to, 2U);
}

TEST(Rpe, PathStepsStartAtTheFirstPointReached) {
  const Trajectory walk = Positions({{0, 0, 0}, {.6, 0, 0}, {1.2, 0, 0}, {1.8, 0, 0}, {2.4, 0, 0}});
  const auto steps = StepsOfPath(Associate(walk, walk), 1.0);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].from, 2U);
  EXPECT_EQ(steps[0].to, 4U);
}

TEST(Rpe, WhatAStepWentBeyondItsDeltaIsNotCarriedOn) {
  const Trajectory walk =
      Positions({{0, 0, 0}, {.7, 0, 0}, {1.4, 0, 0}, {2.1, 0, 0}, {2.8, 0, 0}, {3.5, 0, 0}});
  const auto steps = StepsOfPath(Associate(walk, walk), 1.0);
  ASSERT_EQ(steps.size(), 1U);  // 2 to 4; with the 0.4 m carried on it would be 2, 3, 5
  EXPECT_EQ(steps[0].from, 2U);
  EXPECT_EQ(steps[0].to, 4U);
}

TEST(Rpe, DoesNotSeeAGlobalTransform) {
  RandomStream random(6, RandomStage::kTest);
  for (int i = 0; i < 50; ++i) {
    const Trajectory reference = RandomTrajectory(random, 10);
    const auto score = ScoreTrajectory(reference, Moved(reference, RandomPose(random, 3.0)));
    EXPECT_LT(score->rpe_frame_translation->max, 1e-12);
    EXPECT_LT(score->rpe_metre_translation->max, 1e-12);
    EXPECT_LT(score->rpe_frame_rotation->max, 1e-7);
  }
}

// Three times what is usual between two poses is no gap, however long that is.
TEST(TimeCoverage, AGapIsShortBesideWhatIsUsual) {
  Trajectory reference, estimate;
  for (int i = 0; i <= 400; ++i) {
    reference.push_back({static_cast<double>(i), {}});
    const bool left_out = i == 40 || (i > 200 && i < 280);
    if (i % 20 == 0 && !left_out) estimate.push_back(reference.back());
  }
  // All but what lies between 200 and 280 s.
  EXPECT_EQ(TimeCoverage(reference, Associate(reference, estimate, 0.01)), 322.0 / 401.0);
}

}  // namespace
}  // namespace depthgrid
