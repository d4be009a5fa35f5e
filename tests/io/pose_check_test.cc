#include "mapper/io/pose_check.h"

#include <gtest/gtest.h>

#include "mapper/io/camera_formats.h"
#include "tests/io/posed_pairs.h"

namespace depthgrid {
namespace {

Pose3 Inverted(const Pose3& pose) { return Inverse(pose); }

Pose3 WFirst(const Pose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;  // x y z w <- w x y z
  return {Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()), pose.translation};
}

Pose3 WLast(const Pose3& pose) {
  const Eigen::Quaterniond& q = pose.rotation;  // w x y z <- x y z w
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

TEST(PoseCheck, RightPosesAreNotDoubted) {
  for (const double noise : {0.0, 0.01, 0.03}) {
    EXPECT_FALSE(DoubtOfPoses(PosedPairs(noise), kPairsCamera, GivenPoses(AsItIs), {})) << noise;
  }
}

// A robot's camera close above the floor, which fills most of its image: SLAM's errors in height
// misfit there, and poses that hardly move fit.
TEST(PoseCheck, ErrorsInHeightOfALowCameraAreNoOtherScale) {
  const auto drives = [](double time_s) {
    return TiltedCamera({0.3 * std::cos(0.5 * time_s), 0.2 * std::sin(0.7 * time_s), 0.3 * time_s},
                        0.25, 0.4, 0.0);
  };
  const auto jumps = [](const Pose3& pose) {
    Pose3 given = pose;
    given.translation.z() += 0.01 * std::sin(400.0 * pose.translation.x());
    return given;
  };
  const std::vector<ImagePair> pairs = PosedPairs(0.005, drives);
  EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, GivenPoses(jumps, 0.0, drives), {}));
  const auto tenfold = [](const Pose3& pose) {
    return Pose3{pose.rotation, 10.0 * pose.translation};
  };
  const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(tenfold, 0.0, drives), {});
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->reading, PoseReading::kScaled);
  EXPECT_NEAR(doubt->scale, 0.1, 0.01);
}

TEST(PoseCheck, NamesHowPosesAreMeant) {
  const auto body = [](const Pose3& pose) {
    Eigen::Matrix3d camera_from_body;  // forward, left, up of the body in the camera's axes
    camera_from_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    return Pose3{pose.rotation * Eigen::Quaterniond(camera_from_body), pose.translation};
  };
  const auto gl = [](const Pose3& pose) {
    return Pose3{pose.rotation * Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()),
                 pose.translation};
  };
  const std::vector<std::pair<PoseReading, PoseChange>> readings = {
      {PoseReading::kWFirst, WFirst},
      {PoseReading::kWLast, WLast},
      {PoseReading::kInverse, Inverted},
      {PoseReading::kAxes, body},
      {PoseReading::kAxes, gl}};
  const std::vector<ImagePair> pairs = PosedPairs(0.01);
  int cases = 0;
  for (const auto& [reading, written] : readings) {
    const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(written), {});
    ASSERT_TRUE(doubt) << cases;
    EXPECT_EQ(doubt->reading, reading) << cases;
    EXPECT_EQ(doubt->time_offset_s, 0.0);
    EXPECT_GT(doubt->misfit, 0.05);
    EXPECT_LT(doubt->better_misfit, 0.02);
    ++cases;
  }
}

// Stands, turns, and stands; all pairs lie where it turns, with time to spare on either side.
Pose3 TurningOn(double time_s) {
  const double first_s = 20 * kPairsFrameS - 0.1, last_s = 95 * kPairsFrameS + 0.5 + 0.3;
  const double went_s = std::clamp(time_s, first_s, last_s) - first_s;
  return TiltedCamera({0.5, 0.3, 0.4 * went_s}, 1.0, 0.2, 0.0);
}

TEST(PoseCheck, SaysHowUnsureAClockIsThatNothingTells) {
  constexpr double kAheadS = -1.9;
  const auto doubt = DoubtOfPoses(PosedPairs(0.0, TurningOn), kPairsCamera,
                                  GivenPoses(AsItIs, kAheadS, TurningOn), {});
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->reading, PoseReading::kShifted);
  EXPECT_NEAR(doubt->time_unsure_s, 0.2, 0.05);
  EXPECT_NEAR(doubt->time_offset_s, kAheadS, doubt->time_unsure_s);
}

TEST(PoseCheck, NamesAnotherClock) {
  const std::vector<ImagePair> pairs = PosedPairs(0.01);
  for (const double ahead_s : {-1.5, -0.5, 0.25, 0.5, 1.5}) {
    const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(AsItIs, ahead_s), {});
    ASSERT_TRUE(doubt) << ahead_s;
    EXPECT_EQ(doubt->reading, PoseReading::kShifted);
    EXPECT_NEAR(doubt->time_offset_s, ahead_s, 0.03);
    EXPECT_GT(doubt->time_unsure_s, 0.0);
    EXPECT_LT(doubt->time_unsure_s, 0.05);
    RecordingOptions mended;
    mended.time_offset_s = doubt->time_offset_s;
    EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, GivenPoses(AsItIs, ahead_s), mended)) << ahead_s;
  }
}

// The order of numbers is that of the file, whatever the poses were turned to since.
TEST(PoseCheck, ReadsYUpPosesAsTheyWereWritten) {
  const auto flip = [](const Pose3& pose) { return FlipY(pose); };
  const auto given = GivenPoses([&](const Pose3& pose) { return flip(WFirst(flip(pose))); });
  const auto doubt = DoubtOfPoses(PosedPairs(0.01), kPairsCamera, given, {}, true);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->reading, PoseReading::kWFirst);
}

// Not another clock, though the images fit better at a time at which the camera moved less.
TEST(PoseCheck, NamesAnotherScale) {
  const std::vector<ImagePair> pairs = PosedPairs(0.01);
  for (const double scale : {0.2, 5.0, 1000.0}) {
    const auto scaled = [&](const Pose3& pose) {
      return Pose3{pose.rotation, scale * pose.translation};
    };
    const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(scaled), {});
    ASSERT_TRUE(doubt) << scale;
    EXPECT_EQ(doubt->reading, PoseReading::kScaled);
    EXPECT_NEAR(doubt->scale * scale, 1.0, 0.05);
  }
}

TEST(PoseCheck, NamesAnotherCamera) {
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  for (const double factor : {0.5, 0.8, 1.3}) {
    PinholeCamera focal = kPairsCamera;
    focal.fx_px *= factor;
    focal.fy_px *= factor;
    PinholeCamera size = focal;
    size.cx_px = factor * (kPairsCamera.cx_px + 0.5) - 0.5;
    size.cy_px = factor * (kPairsCamera.cy_px + 0.5) - 0.5;
    const auto wrong_focal = DoubtOfPoses(pairs, focal, GivenPoses(AsItIs), {});
    ASSERT_TRUE(wrong_focal) << factor;
    EXPECT_EQ(wrong_focal->reading, PoseReading::kFocal) << factor;
    EXPECT_NEAR(wrong_focal->scale * factor, 1.0, 0.03) << factor;
    const auto wrong_size = DoubtOfPoses(pairs, size, GivenPoses(AsItIs), {});
    ASSERT_TRUE(wrong_size) << factor;
    EXPECT_EQ(wrong_size->reading, PoseReading::kImageSize) << factor;
    EXPECT_NEAR(wrong_size->scale * factor, 1.0, 0.03) << factor;
  }
}

// Of images that were cut, with the camera's file as it was.
TEST(PoseCheck, NamesAnotherCentre) {
  const std::vector<ImagePair> pairs = PosedPairs(0.0);
  for (const auto& [right_px, down_px] : {std::pair(0.15, 0.0), {-0.1, 0.08}, {0.0, -0.12}}) {
    const Eigen::Vector2d off_px = kPairsCamera.width_px * Eigen::Vector2d(right_px, down_px);
    PinholeCamera camera = kPairsCamera;
    camera.cx_px += off_px.x();
    camera.cy_px += off_px.y();
    const auto doubt = DoubtOfPoses(pairs, camera, GivenPoses(AsItIs), {});
    ASSERT_TRUE(doubt) << off_px;
    EXPECT_EQ(doubt->reading, PoseReading::kCentre) << off_px;
    EXPECT_NEAR(doubt->centre_px.x(), kPairsCamera.cx_px, 0.02 * kPairsCamera.width_px);
    EXPECT_NEAR(doubt->centre_px.y(), kPairsCamera.cy_px, 0.02 * kPairsCamera.width_px);
  }
}

// Of a robot's axes, and of a camera's that were not tilted with it.
TEST(PoseCheck, NamesAMountingAngle) {
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  for (const double down_deg : {-20.0, 15.0, 30.0}) {
    const Eigen::Quaterniond level_from_camera(
        Eigen::AngleAxisd(-RadFromDeg(down_deg), Eigen::Vector3d::UnitX()));
    const auto level = [&](const Pose3& pose) {
      return Pose3{pose.rotation * level_from_camera.inverse(), pose.translation};
    };
    const auto body = [&](const Pose3& pose) {
      const Eigen::Quaterniond camera_from_body = CameraOf(Pose2{}, 0.0).rotation.inverse();
      return Pose3{level(pose).rotation * camera_from_body, pose.translation};
    };
    const auto of_level = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(level), {});
    ASSERT_TRUE(of_level) << down_deg;
    EXPECT_EQ(of_level->reading, PoseReading::kPitched) << down_deg;
    EXPECT_NEAR(DegFromRad(of_level->down_rad), down_deg, 2.0);
    const auto of_body = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(body), {});
    ASSERT_TRUE(of_body) << down_deg;
    EXPECT_EQ(of_body->reading, PoseReading::kPitchedBodyAxes) << down_deg;
    EXPECT_NEAR(DegFromRad(of_body->down_rad), down_deg, 2.0);
  }
}

TEST(PoseCheck, SaysNothingWhereTooLittleIsKnown) {
  std::vector<ImagePair> pairs = PosedPairs(0.0);
  EXPECT_FALSE(DoubtOfPoses({}, kPairsCamera, GivenPoses(Inverted), {}));
  EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, {}, {}));
  pairs.resize(5);
  EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, GivenPoses(Inverted), {}));
}

// Positions of one axis order and rotations of another; a left-handed world.
TEST(PoseCheck, NamesOtherAxes) {
  const auto swapped = [](const Pose3& pose) {
    const Eigen::Vector3d& t = pose.translation;
    return Pose3{pose.rotation, {t.y(), t.x(), t.z()}};
  };
  const auto negated = [](const Pose3& pose) {
    const Eigen::Vector3d& t = pose.translation;
    return Pose3{pose.rotation, {-t.x(), -t.y(), t.z()}};
  };
  const auto left_handed = [](const Pose3& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    const Eigen::Vector3d& t = pose.translation;
    return Pose3{Eigen::Quaterniond(q.w(), q.x(), -q.y(), -q.z()), {-t.x(), t.y(), t.z()}};
  };
  Eigen::Matrix3d swap_xy;
  swap_xy << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  const Eigen::Matrix3d negate_xy = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  const Eigen::Matrix3d mirror_x = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  const std::vector<ImagePair> pairs = PosedPairs(0.01);
  const auto expect = [&](const PoseChange& written, PoseReading reading,
                          const Eigen::Matrix3d& axes) {
    const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(written), {});
    ASSERT_TRUE(doubt);
    EXPECT_EQ(doubt->reading, reading);
    EXPECT_EQ(doubt->axes, axes);
    EXPECT_LT(doubt->better_misfit, 0.02);
  };
  expect(swapped, PoseReading::kPositions, swap_xy);
  expect(negated, PoseReading::kPositions, negate_xy);
  expect(left_handed, PoseReading::kAxes, mirror_x);
}

// A camera with negative fy asks for poses of a y that points up, one with positive fy for others.
TEST(PoseCheck, NamesTheOtherSignOfFy) {
  const auto flip = [](const Pose3& pose) { return FlipY(pose); };
  const std::vector<ImagePair> pairs = PosedPairs(0.002);
  const auto of_y_down = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(flip), {}, true);
  ASSERT_TRUE(of_y_down);
  EXPECT_EQ(of_y_down->reading, PoseReading::kYDown);
  const auto of_y_up = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(flip), {});
  ASSERT_TRUE(of_y_up);
  EXPECT_EQ(of_y_up->reading, PoseReading::kYUp);
  EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, GivenPoses(AsItIs), {}, true));
}

TEST(PoseCheck, NamesRayLengths) {
  std::vector<ImagePair> pairs = PosedPairs(0.002);
  const auto as_rays = [](const DepthImage& image) {
    auto rays = std::make_shared<DepthImage>(image);
    for (int v = 0; v < image.height_px; ++v) {
      for (int u = 0; u < image.width_px; ++u) {
        rays->Row(v)[u] *= static_cast<float>(Unproject(kPairsCamera, u, v, 1.0).norm());
      }
    }
    return rays;
  };
  for (ImagePair& pair : pairs) {
    pair.first = as_rays(*pair.first);
    pair.second = as_rays(*pair.second);
  }
  const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(AsItIs), {});
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->reading, PoseReading::kRayLengths);
}

TEST(PoseCheck, SaysOfPosesThatFitInNoReading) {
  std::vector<ImagePair> pairs = PosedPairs(0.0);
  const auto reading = [&](const PoseChange& written) {
    const auto doubt = DoubtOfPoses(pairs, kPairsCamera, GivenPoses(written), {});
    EXPECT_TRUE(doubt);
    return doubt ? doubt->reading : PoseReading::kWFirst;
  };
  EXPECT_EQ(reading([](const Pose3&) { return Pose3{}; }), PoseReading::kStanding);
  EXPECT_EQ(reading([](const Pose3& pose) {
              return Pose3{Eigen::Quaterniond::Identity(), pose.translation};
            }),
            PoseReading::kUnturned);
  // Images in another order than their stamps.
  for (std::size_t i = 0; i < pairs.size() / 2; ++i) {
    std::swap(pairs[i].first, pairs[pairs.size() - 1 - i].second);
  }
  EXPECT_EQ(reading(AsItIs), PoseReading::kNone);
  EXPECT_FALSE(DoubtOfPoses(pairs, kPairsCamera, GivenPoses(AsItIs), {})->kept);
}

// In the columns from 16 to 63 of 80, .8 m away.
std::vector<ImagePair> PairsBehindSomebody(bool in_order) {
  std::vector<ImagePair> pairs = PosedPairs(0.005);
  if (!in_order) {
    for (std::size_t i = 0; i < pairs.size() / 2; ++i) {
      std::swap(pairs[i].first, pairs[pairs.size() - 1 - i].second);
    }
  }
  const auto hidden = [](const DepthImage& image) {
    auto with_somebody = std::make_shared<DepthImage>(image);
    for (int v = 0; v < image.height_px; ++v) std::fill_n(with_somebody->Row(v) + 16, 48, 0.8F);
    return with_somebody;
  };
  for (ImagePair& pair : pairs) {
    pair.first = hidden(*pair.first);
    pair.second = hidden(*pair.second);
  }
  return pairs;
}

TEST(PoseCheck, SomebodyWhoKeepsAheadIsNoReasonToDoubtRightPoses) {
  EXPECT_FALSE(DoubtOfPoses(PairsBehindSomebody(true), kPairsCamera, GivenPoses(AsItIs), {}));
}

TEST(PoseCheck, BehindSomebodyWrongPosesAreDoubtedAndTheirPlaceIsTold) {
  const auto doubt = DoubtOfPoses(PairsBehindSomebody(false), kPairsCamera, GivenPoses(AsItIs), {});
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->reading, PoseReading::kNone);
  ASSERT_TRUE(doubt->kept);
  EXPECT_GT(doubt->kept->share, 0.5);
  EXPECT_NEAR(doubt->kept->depth_m, 0.8, 0.05);
  EXPECT_NEAR(doubt->kept->first_column_px, 21, 5);
  EXPECT_NEAR(doubt->kept->last_column_px, 58, 5);
}

// Half a turn a second: every pair shows two walls, and its poses are right.
TEST(PoseCheck, ACameraThatTurnsTooFastToTellIsNotDoubted) {
  const auto whirling = [](double time_s) {
    return TiltedCamera({0.5, 0.3, kPi * time_s}, 1.0, 0.2, 0.0);
  };
  EXPECT_FALSE(
      DoubtOfPoses(PosedPairs(0.0, whirling), kPairsCamera, GivenPoses(AsItIs, 0.0, whirling), {}));
}

}  // namespace
}  // namespace depthgrid
