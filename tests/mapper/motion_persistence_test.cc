#include "mapper/surfel/motion_persistence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/surfel/joint_adjustment.h"
#include "mapper/surfel/skyline_matrix.h"

namespace depthgrid {
namespace {

const Eigen::Vector3d kAllSeen = Eigen::Vector3d::Ones();

// Motions of a metre whose errors forward keep `kept` of the one before; to the left and in yaw
// they are independent.
struct BiasedDrive {
  std::vector<Pose2> map_from_group = std::vector<Pose2>(1);
  std::vector<GroupLink> links;
};

BiasedDrive DriveOf(int motions, double kept) {
  RandomStream random(4, RandomStage::kTest);
  BiasedDrive drive;
  double forward_m = 0.0;
  for (int i = 1; i <= motions; ++i) {
    forward_m = kept * forward_m + std::sqrt(1.0 - kept * kept) * 0.01 * random.Normal();
    drive.map_from_group.push_back(drive.map_from_group.back() * Pose2{1.0, 0.0, 0.0});
    const Pose2 error{-forward_m, 0.01 * random.Normal(), 0.001 * random.Normal()};
    drive.links.push_back({i - 1, i, Pose2{1.0, 0.0, 0.0} * error, kAllSeen, 0.0});
  }
  return drive;
}

Eigen::Vector3d Told(const std::vector<GroupLink>& links, const BiasedDrive& drive,
                     const Eigen::Vector3d& share_seen) {
  return MotionPersistence(links, drive.map_from_group, {links.size(), share_seen});
}

TEST(MotionPersistence, IsThatOfTheErrors) {
  for (const double kept : {0.7, 0.9}) {
    const BiasedDrive drive = DriveOf(4000, kept);
    const Eigen::Vector3d told = Told(drive.links, drive, kAllSeen);
    EXPECT_NEAR(told.x(), kept, 0.03);
    EXPECT_LT(told.y(), 0.3);
    EXPECT_LT(told.z(), 0.3);
  }
}

TEST(MotionPersistence, IsNoneWhereLittleWasSeenOrLinksAreFew) {
  const BiasedDrive drive = DriveOf(400, 0.9);
  EXPECT_TRUE(Told(drive.links, drive, {0.2, 1.0, 1.0}).isZero(0.0));
  EXPECT_GT(Told(drive.links, drive, kAllSeen).x(), 0.8);
  const std::vector<GroupLink> few(drive.links.begin(), drive.links.begin() + 20);
  EXPECT_TRUE(Told(few, drive, kAllSeen).isZero(0.0));
  // Every fourth motion is not known: none follows on another four before.
  std::vector<GroupLink> broken;
  for (std::size_t i = 0; i < drive.links.size(); ++i) {
    if (i % 4 != 0) broken.push_back(drive.links[i]);
  }
  EXPECT_TRUE(Told(broken, drive, kAllSeen).isZero(0.0));
}

// In rooms a narrow view tells how far and which way, but little of how far to the side. With
// errors there believed to be independent, which forward last, what builds up is laid to the yaw.
TEST(MotionPersistence, OfAnAxisThatIsNotSeenIsTheLeastOfTheOthers) {
  const BiasedDrive forward = DriveOf(4000, 0.9);
  EXPECT_GT(Told(forward.links, forward, {1.0, 0.2, 0.2}).minCoeff(), 0.8);
  EXPECT_LT(Told(forward.links, forward, {1.0, 1.0, 0.2}).z(), 0.3);
}

// Of 64 pairs 36 agree: as many do by chance. With 40 they agree by a quarter, of which a standard
// error is an eighth.
TEST(MotionPersistence, IsWhatIsLeftOfTheAgreementLessItsStandardError) {
  for (const auto& [agreeing, correlation] :
       {std::pair(36, 0.0), {40, std::sin(0.5 * kPi * 0.125)}}) {
    BiasedDrive drive = DriveOf(68, 0.0);
    double forward_m[68];
    for (int i = 0; i < 68; ++i) {
      const bool agrees = i < 4 || i - 4 < agreeing;
      forward_m[i] = i < 4 ? 0.01 : (agrees ? 1.0 : -1.0) * forward_m[i - 4];
      const auto link = static_cast<std::size_t>(i);
      drive.links[link].first_from_second = Pose2{1.0 - forward_m[i], 0.0, 0.0};
    }
    EXPECT_NEAR(Told(drive.links, drive, kAllSeen).x(), std::pow(correlation, 0.25), 1e-9);
  }
}

// What was not seen goes on as its neighbours do: it says nothing of whether errors last.
TEST(MotionPersistence, IsOfTheMotionsThatWereSeen) {
  BiasedDrive drive = DriveOf(2000, 0.7);
  std::vector<Eigen::Vector3d> shares(drive.links.size(), kAllSeen);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (i % 100 >= 50) continue;
    shares[i].x() = 0.1;
    drive.links[i].first_from_second = Pose2{1.0, 0.0, 0.0} * Pose2{0.01, 0.0, 0.0};
  }
  const auto told = [&](const std::vector<Eigen::Vector3d>& seen) {
    return MotionPersistence(drive.links, drive.map_from_group, seen).x();
  };
  EXPECT_NEAR(told(shares), 0.7, 0.1);
  EXPECT_GT(told({shares.size(), kAllSeen}), 0.85);
}

TEST(AddMotions, NormalEquationsAreThoseOfNumericDerivatives) {
  const std::vector<Pose2> poses = {{0.3, -0.2, 0.4}, {1.1, 0.5, 1.0}, {1.4, 1.2, 0.7}};
  const auto link = [&](int first, const Pose2& error, const Eigen::Vector3d& sigma) {
    const auto i = static_cast<std::size_t>(first);
    return GroupLink{first, first + 1, Between(poses[i], poses[i + 1]) * error, sigma, 0.0};
  };
  const std::vector<GroupLink> links = {link(0, {1e-4, -2e-4, 1e-4}, {0.1, 0.2, 0.05}),
                                        link(1, {-2e-4, 1e-4, 3e-4}, {0.2, 0.1, 0.1})};
  const Eigen::Vector3d persistence(0.9, 0.5, 0.0);
  // Of x the second sigma has grown threefold: the error that goes on is a third as many sigmas.
  const std::vector<Eigen::Vector3d> growth = {{2.0, 6.0, 1.0}, {6.0, 2.0, 1.0}};
  const Eigen::Vector3d going_on(0.9 / 3.0, 0.5, 0.0);
  // The first error over its sigma; what is new in the second.
  const auto residuals = [&](const std::vector<Pose2>& at) {
    const Eigen::Vector3d before = LinkError(links[0], at).cwiseQuotient(links[0].sigma);
    const Eigen::Vector3d now = LinkError(links[1], at).cwiseQuotient(links[1].sigma);
    const Eigen::Vector3d renewed = (1.0 - persistence.array().square()).sqrt().matrix();
    Eigen::Matrix<double, 6, 1> both;
    both << before, (now - going_on.cwiseProduct(before)).cwiseQuotient(renewed);
    return both;
  };
  Eigen::Matrix<double, 6, 9> jacobian;
  for (int k = 0; k < 9; ++k) {
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    step[k % 3] = 1e-6;
    std::vector<Pose2> moved = poses;
    Pose2& pose = moved[static_cast<std::size_t>(k / 3)];
    pose = pose * Pose2::FromVector(step);
    jacobian.col(k) = (residuals(moved) - residuals(poses)) / 1e-6;
  }
  SkylineMatrix h(std::vector<int>(9, 0));
  Eigen::VectorXd g = Eigen::VectorXd::Zero(9);
  AddMotions(links, persistence, growth, poses, h, g);
  const Eigen::MatrixXd expected = jacobian.transpose() * jacobian;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j <= i; ++j) {
      EXPECT_NEAR(*h.At(i, j), expected(i, j), 1e-3 * expected.diagonal().maxCoeff()) << i << j;
    }
  }
  EXPECT_LT((g + jacobian.transpose() * residuals(poses)).norm(), 1e-3);
}

constexpr int kManyGroups = 100;
constexpr double kGroupStepM = 0.2;
constexpr int kFirstBlind = 50;
constexpr int kLastBlind = 68;

Surfel WallAt(double x_m, double y_m, const Eigen::Vector2d& normal) {
  Surfel surfel;
  surfel.point_m = {x_m, y_m};
  surfel.normal = normal;
  surfel.information = 1e6;
  surfel.normal_information = 1e4;
  return surfel;
}

// Two walls along x; posts across every metre tell how far along they were seen from, but for a
// stretch with none in view.
std::vector<Surfel> SeenFrom(double at_m) {
  std::vector<Surfel> surfels;
  for (double x_m = 0.5; x_m < 3.0; x_m += 0.05) {
    for (const double side : {-1.0, 1.0}) surfels.push_back(WallAt(x_m, side, {0.0, -side}));
  }
  for (int post = 0; post < 30; ++post) {
    const double ahead_m = post - at_m;
    const bool blind = at_m > kFirstBlind * kGroupStepM && at_m < kLastBlind * kGroupStepM;
    if (blind || ahead_m < 0.5 || ahead_m > 3.0) continue;
    for (const double y_m : {-0.9, -0.8, 0.8, 0.9}) {
      surfels.push_back(WallAt(ahead_m, y_m, {-1.0, 0.0}));
    }
  }
  return surfels;
}

// How far the group at the end of the blind stretch lies from the one at its beginning, off its
// true distance; SLAM says 1.5 mm too much with each frame.
double OffOverBlindStretch(bool learn_persistence) {
  constexpr int kFrames = 5;
  const double slam_m = kGroupStepM + kFrames * 0.0015;
  std::vector<SurfelGroup> groups;
  std::vector<GroupMotion> motions;
  for (int g = 0; g < kManyGroups; ++g) {
    SurfelGroup group;
    group.first_frame = g * kFrames;
    group.frames = kFrames;
    group.surfels = SeenFrom(g * kGroupStepM);
    // As online: true while posts are seen, by SLAM without them.
    const int blind = std::clamp(g - kFirstBlind, 0, kLastBlind - kFirstBlind);
    group.map_from_group = {g * kGroupStepM + blind * (slam_m - kGroupStepM), 0.0, 0.0};
    groups.push_back(group);
    motions.push_back({true, {slam_m, 0.0, 0.0}, kFrames});
  }
  JointOptions options;
  options.learn_persistence = learn_persistence;
  const JointResult result = AdjustJointly(groups, motions, {}, options);
  const double moved_m =
      Between(result.map_from_group[kFirstBlind], result.map_from_group[kLastBlind]).x_m;
  return std::abs(moved_m - (kLastBlind - kFirstBlind) * kGroupStepM);
}

// The posts of the far side were not seen before: nothing but SLAM says how far they are.
TEST(MotionPersistence, CarriesAKnownBiasThroughABlindStretch) {
  const double alone_m = OffOverBlindStretch(false);
  EXPECT_GT(alone_m, 0.07);
  EXPECT_LT(OffOverBlindStretch(true), 0.4 * alone_m);
}

}  // namespace
}  // namespace depthgrid
