#include "mapper/io/slight_doubt.h"

#include <gtest/gtest.h>

#include <vector>

#include "mapper/core/rng.h"
#include "mapper/io/pose_check.h"
#include "tests/io/posed_pairs.h"

namespace depthgrid {
namespace {

TEST(SlightDoubt, NamesASlightlyWrongCamera) {
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  for (const double factor : {0.94, 0.97, 1.03, 1.06}) {
    PinholeCamera focal = kPairsCamera;
    focal.fx_px *= factor;
    focal.fy_px *= factor;
    const auto doubt = DoubtOfPoses(pairs, focal, GivenPoses(AsItIs), {});
    ASSERT_TRUE(doubt) << factor;
    EXPECT_EQ(doubt->reading, PoseReading::kFocal) << factor;
    EXPECT_NEAR(doubt->scale * factor, 1.0, 0.01) << factor;
    EXPECT_GT(doubt->sigma, 0.0);
    EXPECT_LT(doubt->sigma, 0.01);
  }
}

TEST(SlightDoubt, NamesSlightlyWrongDepthAndStamps) {
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  const auto scaled = [](const Pose3& pose) {
    return Pose3{pose.rotation, 1.05 * pose.translation};
  };
  const auto scale = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(scaled), {});
  ASSERT_TRUE(scale);
  EXPECT_EQ(scale->reading, PoseReading::kScaled);
  EXPECT_NEAR(scale->scale * 1.05, 1.0, 0.01);
  RecordingOptions options;
  options.time_offset_s = 1.0;
  const auto shifted = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(AsItIs, 1.1), options);
  ASSERT_TRUE(shifted);
  EXPECT_EQ(shifted->reading, PoseReading::kShifted);
  EXPECT_NEAR(shifted->time_offset_s, 1.1, 0.02);
}

// Thirty poses a second, `ahead_s` ahead, each erring by itself by 4 mm and 2 mrad.
std::vector<SlamPose> JitteringPoses(double ahead_s) {
  constexpr double kStepS = 1.0 / 30.0;
  RandomStream random(7, RandomStage::kTest);
  std::vector<SlamPose> live;
  for (int i = -60; i < 480; ++i) {
    Pose3 given = TruePoseAt(i * kStepS - ahead_s);
    for (int axis = 0; axis < 3; ++axis) {
      given.translation[axis] += 0.004 * random.Normal();
      given.rotation =
          given.rotation * Eigen::AngleAxisd(0.002 * random.Normal(), Eigen::Vector3d::Unit(axis));
    }
    live.push_back({i * kStepS, given, 0});
  }
  return live;
}

// Halfway between two poses their mean jitters less than the pose that fits.
TEST(SlightDoubt, NamesStampsThatLieBetweenPosesThatJitter) {
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, JitteringPoses(0.0), {}));
  for (const double ahead_s : {-0.05, 0.05}) {
    const auto doubt = DoubtOfPoses(pairs, kPairsCamera, JitteringPoses(ahead_s), {});
    ASSERT_TRUE(doubt) << ahead_s;
    EXPECT_EQ(doubt->reading, PoseReading::kShifted) << ahead_s;
    EXPECT_NEAR(doubt->time_offset_s, ahead_s, 0.01) << ahead_s;
  }
}

// SLAM's own errors over a few seconds look like a wrong focal length, but leave a large misfit.
TEST(SlightDoubt, WhereSlamErrsMuchNothingSlightIsNamed) {
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  const auto errs = [](const Pose3& pose) {
    Pose3 given = pose;
    given.translation += 0.03 * Eigen::Vector3d(std::sin(9.0 * pose.translation.x()),
                                                std::sin(7.0 * pose.translation.y()), 0.0);
    return given;
  };
  for (const double factor : {0.97, 1.0, 1.03}) {
    PinholeCamera focal = kPairsCamera;
    focal.fx_px *= factor;
    focal.fy_px *= factor;
    EXPECT_FALSE(DoubtOfPoses(pairs, focal, GivenPoses(errs), {})) << factor;
  }
}

}  // namespace
}  // namespace depthgrid
