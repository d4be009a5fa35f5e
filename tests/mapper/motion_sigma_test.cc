#include "mapper/surfel/motion_sigma.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/surfel/skyline_matrix.h"

namespace depthgrid {
namespace {

constexpr double kAnchor = 1e12;

// Poses one metre apart, each linked to the one before; the first stays where it is.
struct Chain {
  std::vector<Pose2> map_from_group;
  std::vector<GroupLink> links;
};

Chain ChainOf(int poses, const Eigen::Vector3d& sigma) {
  Chain chain;
  for (int i = 0; i < poses; ++i) {
    chain.map_from_group.push_back({static_cast<double>(i), 0.0, 0.1 * i});
    if (i == 0) continue;
    const Pose2 motion = Between(chain.map_from_group[static_cast<std::size_t>(i - 1)],
                                 chain.map_from_group[static_cast<std::size_t>(i)]);
    chain.links.push_back({i - 1, i, motion, sigma, 0.0});
  }
  return chain;
}

SkylineMatrix EquationsOf(const Chain& chain) {
  const auto poses = static_cast<int>(chain.map_from_group.size());
  SkylineMatrix h(std::vector<int>(static_cast<std::size_t>(3 * poses), 0));
  for (int i = 0; i < 3; ++i) h.Diagonal(i) += kAnchor;
  Eigen::VectorXd g = Eigen::VectorXd::Zero(h.size());
  for (const GroupLink& link : chain.links) AddLink(link, chain.map_from_group, h, g);
  return h;
}

// A pose seen with information d: of what is known of the motion, d / (d + 1 / sigma^2) was seen.
TEST(SharesSeen, IsWhatThePriorDoesNotTell) {
  const Chain chain = ChainOf(2, {0.1, 0.2, 0.05});
  SkylineMatrix h = EquationsOf(chain);
  h.Diagonal(3) += 300.0;  // forward: 300 against 100
  h.Diagonal(4) += 25.0;   // left: as much as the prior; yaw: nothing
  ASSERT_TRUE(h.Factor());
  const Eigen::Vector3d share = SharesSeen(chain.links, chain.map_from_group, h)[0];
  EXPECT_NEAR(share.x(), 0.75, 1e-9);
  EXPECT_NEAR(share.y(), 0.5, 1e-9);
  EXPECT_NEAR(share.z(), 0.0, 1e-9);
}

TEST(SeenSigma, IsLargeWhereLittleWasSeen) {
  const Eigen::Vector3d seen = SeenSigma({0.1, 0.2, 0.05}, {{1.0, 0.25, 0.0}});
  EXPECT_NEAR(seen.x(), 0.1, 1e-12);
  EXPECT_NEAR(seen.y(), 0.4, 1e-12);
  EXPECT_TRUE(std::isinf(seen.z()));
}

TEST(SharesSeen, ManyLinksAreEstimatedWell) {
  const Chain chain = ChainOf(200, {0.02, 0.01, 0.004});
  SkylineMatrix h = EquationsOf(chain);
  RandomStream random(1, RandomStage::kTest);
  // Seen are the motions over thirty poses.
  Eigen::VectorXd none = Eigen::VectorXd::Zero(h.size());
  for (int i = 30; i < 200; ++i) {
    const double sigma = 0.005 + 0.02 * random.Uniform();
    const Pose2 motion = Between(chain.map_from_group[static_cast<std::size_t>(i - 30)],
                                 chain.map_from_group[static_cast<std::size_t>(i)]);
    AddLink({i - 30, i, motion, {sigma, sigma, sigma}, 0.0}, chain.map_from_group, h, none);
  }
  Eigen::MatrixXd dense(h.size(), h.size());
  for (int row = 0; row < h.size(); ++row) {
    for (int column = 0; column <= row; ++column) {
      dense(row, column) = dense(column, row) = *h.At(row, column);
    }
  }
  const Eigen::MatrixXd covariance =
      dense.ldlt().solve(Eigen::MatrixXd::Identity(h.size(), h.size()));
  Eigen::Vector3d exact = Eigen::Vector3d::Ones();
  for (const GroupLink& link : chain.links) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, h.size());
    rows.block<3, 3>(0, 3 * link.first) = ErrorByFirst(link, chain.map_from_group);
    rows.block<3, 3>(0, 3 * link.second).setIdentity();
    const Eigen::Matrix3d left = rows * covariance * rows.transpose();
    exact -= left.diagonal().cwiseQuotient(link.sigma.cwiseAbs2()) / 199.0;
  }
  ASSERT_TRUE(h.Factor());
  const std::vector<Eigen::Vector3d> shares = SharesSeen(chain.links, chain.map_from_group, h);
  const Eigen::Vector3d share = MeanShare(shares);
  EXPECT_GT(exact.minCoeff(), 0.02);
  EXPECT_LT(exact.maxCoeff(), 0.9);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(share[axis], exact[axis], 0.03) << axis;
}

// The first half of the way nothing is seen, the second each pose far better than the prior knows a
// motion.
TEST(SharesSeen, AreEachLinksOwn) {
  const Chain chain = ChainOf(200, {0.02, 0.01, 0.004});
  SkylineMatrix h = EquationsOf(chain);
  for (int i = 3 * 100; i < h.size(); ++i) h.Diagonal(i) += 1e9;
  ASSERT_TRUE(h.Factor());
  const std::vector<Eigen::Vector3d> shares = SharesSeen(chain.links, chain.map_from_group, h);
  ASSERT_EQ(shares.size(), 199U);
  for (std::size_t i = 0; i < 95; ++i) EXPECT_LT(shares[i].maxCoeff(), 0.1) << i;
  for (std::size_t i = 105; i < 199; ++i) EXPECT_GT(shares[i].minCoeff(), 0.99) << i;
}

TEST(SharesSeen, WithoutLinksAllIsSeen) {
  EXPECT_EQ(MeanShare({}), Eigen::Vector3d(Eigen::Vector3d::Ones()));
}

// Adjusted between a prior and sightings of the same variance, motions show half of the prior's
// errors: shrunk to half, and share is half.
TEST(MotionSigma, CountsWhatThePriorHasDrawnToItself) {
  constexpr double kTrueSigma = 0.003;
  constexpr int kMotions = 40000;  // the median's own error is 0.6 %
  RandomStream random(2, RandomStage::kTest);
  std::vector<GroupLink> links;
  std::vector<Pose2> poses(1);
  for (int i = 1; i <= kMotions; ++i) {
    const double prior_error = kTrueSigma * random.Normal();
    const double sight_error = kTrueSigma * random.Normal();
    const double left_after = 0.5 * (sight_error - prior_error);
    poses.push_back(poses.back() * Pose2{1.0 + left_after, 0.0, 0.0});
    links.push_back({i - 1, i, {1.0, 0.0, 0.0}, Eigen::Vector3d::Ones(), 0.0});
  }
  const Eigen::Vector3d sigma =
      MotionSigma(links, poses, std::vector(links.size(), Eigen::Vector3d(0.5, 0.5, 0.5)));
  EXPECT_NEAR(sigma.x(), kTrueSigma, 0.02 * kTrueSigma);
  // To the left nothing was seen of an error, but that direction is not that much better.
  EXPECT_DOUBLE_EQ(sigma.y(), 0.5 * sigma.x());
  EXPECT_DOUBLE_EQ(sigma.z(), 0.25 * sigma.x());
}

// Before one wall of a hall yaw and one direction are seen at the most.
TEST(MotionSigma, IsNotFarBetterAlongWhatWasNotSeenThanInYaw) {
  Chain chain = ChainOf(21, Eigen::Vector3d::Ones());
  for (GroupLink& link : chain.links) link.first_from_second.yaw_rad += 0.001;
  const std::vector<Eigen::Vector3d> yaw_seen(chain.links.size(), Eigen::Vector3d(0.0, 0.0, 1.0));
  const Eigen::Vector3d sigma = MotionSigma(chain.links, chain.map_from_group, yaw_seen);
  EXPECT_NEAR(sigma.z(), 1.4826 * 0.001, 1e-6);
  EXPECT_GE(sigma.head<2>().minCoeff(), 0.5 * sigma.z());  // m of rad
}

TEST(MotionSigma, OneWrongMotionIsNotTheRule) {
  Chain chain = ChainOf(21, Eigen::Vector3d::Ones());
  for (GroupLink& link : chain.links) link.first_from_second.x_m += 0.001;
  const std::vector<Eigen::Vector3d> share(chain.links.size(), Eigen::Vector3d::Ones());
  const Eigen::Vector3d before = MotionSigma(chain.links, chain.map_from_group, share);
  chain.links[7].first_from_second.x_m += 5.0;
  const Eigen::Vector3d after = MotionSigma(chain.links, chain.map_from_group, share);
  EXPECT_NEAR(after.x(), before.x(), 0.01 * before.x());
}

// Where nothing is seen the poses are the prior's, and its errors nought.
TEST(MotionSigma, MotionsThatNobodySawSayNothing) {
  Chain chain = ChainOf(100, Eigen::Vector3d::Ones());
  std::vector<Eigen::Vector3d> shares(chain.links.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < 10; ++i) {
    chain.links[i].first_from_second.x_m += 0.001;
    shares[i].setConstant(1.0);
  }
  const double seen = MotionSigma(chain.links, chain.map_from_group, shares).x();
  EXPECT_NEAR(seen, 1.4826 * 0.001, 2e-5);  // the motions turn
  std::fill(shares.begin(), shares.end(), MeanShare(shares));
  EXPECT_LT(MotionSigma(chain.links, chain.map_from_group, shares).x(), 0.1 * seen);
}

TEST(MotionSigma, WhereNothingWasSeenAllMotionsCountAlike) {
  Chain chain = ChainOf(21, Eigen::Vector3d::Ones());
  for (GroupLink& link : chain.links) link.first_from_second.x_m += 0.001;
  const std::vector<Eigen::Vector3d> shares(chain.links.size(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(MotionSigma(chain.links, chain.map_from_group, shares).x(),
              1.4826 * 0.001 / std::sqrt(kLeastShareSeen), 3e-5);
}

// Believed to 1 mm a frame, of which half was seen; between poses 30 and 40 the errors are 10 cm.
TEST(MotionGrowth, IsWhereSlamErrsByFarMoreThanElsewhere) {
  const std::vector<GroupLink> unit = ChainOf(61, Eigen::Vector3d::Ones()).links;
  const std::vector<GroupLink> believed = ChainOf(61, Eigen::Vector3d::Constant(0.001)).links;
  const std::vector<Eigen::Vector3d> shares(60, Eigen::Vector3d::Constant(0.5));
  const Eigen::Vector3d sigma = Eigen::Vector3d::Constant(0.001);
  std::vector<Pose2> poses{{0.0, 0.0, 0.0}};
  for (int i = 0; i < 60; ++i) {
    const double error_m = i >= 30 && i < 40 ? 0.1 : (i % 2 == 0 ? 0.001 : -0.001);
    poses.push_back(poses.back() * unit[static_cast<std::size_t>(i)].first_from_second *
                    Pose2{error_m, 0.0, 0.0});
  }
  const std::vector<Eigen::Vector3d> growth =
      MotionGrowth(unit, believed, poses, shares, sigma, {});
  for (int i = 0; i < 60; ++i) {
    const double forward = growth[static_cast<std::size_t>(i)].x();
    if (i >= 32 && i < 38) {
      EXPECT_NEAR(forward, 100.0 * 1.4826 / std::sqrt(0.5), 1.0) << i;
    } else if (i < 28 || i > 42) {
      EXPECT_EQ(forward, 1.0) << i;
    }
    EXPECT_EQ(growth[static_cast<std::size_t>(i)].z(), 1.0) << i;
  }
  // One wrong motion alone tells of itself and not of its neighbours, and of itself if it was seen.
  std::vector<Pose2> jumped{{0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < 60; ++i) {
    jumped.push_back(jumped.back() * unit[i].first_from_second *
                     Pose2{i == 20 ? 0.5 : 0.0005, 0.0, 0.0});
  }
  const std::vector<Eigen::Vector3d> none(60, Eigen::Vector3d::Ones());
  const auto alone = [&](double share) {
    std::vector<Eigen::Vector3d> seen = shares;
    seen[20].setConstant(share);
    return MotionGrowth(unit, believed, jumped, seen, sigma, none);
  };
  EXPECT_EQ(alone(0.2)[20], Eigen::Vector3d::Ones());
  EXPECT_NEAR(alone(0.5)[20].x(), 500.0 / 0.5, 1.0);
  for (const std::size_t i : {19U, 21U}) EXPECT_EQ(alone(0.5)[i], Eigen::Vector3d::Ones()) << i;
}

// What was seen errs by ten times SLAM, and one motion is believed to a hundred times it: that it
// differs by ten is no more than what was seen errs by.
TEST(MotionGrowth, OfAMotionAloneIsNotWhatWasSeenErrsBy) {
  const std::vector<GroupLink> unit = ChainOf(21, Eigen::Vector3d::Ones()).links;
  std::vector<GroupLink> believed = ChainOf(21, Eigen::Vector3d::Constant(0.001)).links;
  std::vector<Eigen::Vector3d> before(20, Eigen::Vector3d::Ones());
  before[10].x() = 100.0;
  believed[10].sigma.x() = 0.1;
  std::vector<Eigen::Vector3d> shares(20, Eigen::Vector3d::Constant(1.0 / 101.0));
  shares[10].x() = 1e4 / (1e4 + 100.0);
  const Eigen::Vector3d sigma = Eigen::Vector3d::Constant(0.001);
  const auto growth_at = [&](double error_m) {
    std::vector<Pose2> poses{{0.0, 0.0, 0.0}};
    for (std::size_t i = 0; i < 20; ++i) {
      poses.push_back(poses.back() * unit[i].first_from_second *
                      Pose2{i == 10 ? error_m : 0.0, 0.0, 0.0});
    }
    return MotionGrowth(unit, believed, poses, shares, sigma, before)[10].x();
  };
  EXPECT_EQ(growth_at(0.01), 1.0);
  EXPECT_EQ(growth_at(0.04), 1.0);
  EXPECT_NEAR(growth_at(0.1), 100.0, 1.0);
}

// Once grown, the errors are about as large as believed, in half of the rounds a little smaller.
// Growth that is dropped then would be there in every second round only.
TEST(MotionGrowth, FollowsErrorsThatAreSmallerThanBelieved) {
  const std::vector<GroupLink> unit = ChainOf(21, Eigen::Vector3d::Ones()).links;
  const std::vector<GroupLink> believed = ChainOf(21, Eigen::Vector3d::Constant(0.1)).links;
  const std::vector<Eigen::Vector3d> shares(20, Eigen::Vector3d::Constant(1.0));
  const std::vector<Eigen::Vector3d> before(20, Eigen::Vector3d::Constant(100.0));
  const Eigen::Vector3d sigma = Eigen::Vector3d::Constant(0.001);
  const auto growth_at = [&](double error_m) {
    std::vector<Pose2> poses{{0.0, 0.0, 0.0}};
    for (const GroupLink& link : unit) {
      poses.push_back(poses.back() * link.first_from_second * Pose2{error_m, 0.0, 0.0});
    }
    return MotionGrowth(unit, believed, poses, shares, sigma, before)[10].x();
  };
  EXPECT_NEAR(growth_at(0.1), 100.0 * 1.4826, 1.0);
  EXPECT_NEAR(growth_at(0.05), 50.0 * 1.4826, 1.0);
  EXPECT_EQ(growth_at(0.002), 1.0);
}

// One motion is believed to a hundred times the common sigma, and all around err by three times it,
// as it does itself: the hundred is not multiplied by what its neighbours err by.
TEST(MotionGrowth, DoesNotFeedOnWhatNeighboursAreBelievedTo) {
  const std::vector<GroupLink> unit = ChainOf(21, Eigen::Vector3d::Ones()).links;
  std::vector<GroupLink> believed = ChainOf(21, Eigen::Vector3d::Constant(0.001)).links;
  std::vector<Eigen::Vector3d> before(20, Eigen::Vector3d::Ones());
  before[10].x() = 100.0;
  believed[10].sigma.x() = 0.1;
  std::vector<Pose2> poses{{0.0, 0.0, 0.0}};
  for (const GroupLink& link : unit) {
    poses.push_back(poses.back() * link.first_from_second * Pose2{0.003, 0.0, 0.0});
  }
  const std::vector<Eigen::Vector3d> shares(20, Eigen::Vector3d::Constant(1.0));
  const Eigen::Vector3d sigma = Eigen::Vector3d::Constant(0.001);
  for (const Eigen::Vector3d& times : MotionGrowth(unit, believed, poses, shares, sigma, before)) {
    EXPECT_EQ(times, Eigen::Vector3d::Ones());
  }
}

// A motion believed to little has followed the sightings less than its neighbours, which are
// believed to much: each shows the same error by its own share.
TEST(MotionGrowth, CountsEachMotionsOwnShare) {
  const std::vector<GroupLink> unit = ChainOf(21, Eigen::Vector3d::Ones()).links;
  std::vector<GroupLink> believed = ChainOf(21, Eigen::Vector3d::Constant(0.001)).links;
  std::vector<Eigen::Vector3d> before(20, Eigen::Vector3d::Ones());
  std::vector<Eigen::Vector3d> shares(20, Eigen::Vector3d::Constant(1.0));
  std::vector<Pose2> poses{{0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < 20; ++i) {
    const bool little = i % 2 == 0;
    if (little) shares[i].x() = 0.25;
    before[i].x() = little ? 1.0 : 20.0;
    believed[i].sigma.x() = little ? 0.001 : 0.02;
    const double error_m = 0.02 * std::sqrt(shares[i].x());
    poses.push_back(poses.back() * unit[i].first_from_second * Pose2{error_m, 0.0, 0.0});
  }
  const Eigen::Vector3d sigma = Eigen::Vector3d::Constant(0.001);
  const auto growth = MotionGrowth(unit, believed, poses, shares, sigma, before);
  for (const std::size_t i : {9U, 10U}) EXPECT_NEAR(growth[i].x(), 20.0 * 1.4826, 0.1) << i;
}

}  // namespace
}  // namespace depthgrid
