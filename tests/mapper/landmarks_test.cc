#include "mapper/surfel/landmarks.h"

#include <gtest/gtest.h>

#include <vector>

#include "mapper/fuse/fusion.h"
#include "mapper/surfel/skyline_matrix.h"

namespace depthgrid {
namespace {

constexpr double kInformation = 1e4;  // 1 cm

// A wall across the view, seen by each group; groups see all of it nearer or farther, each by its
// own error.
std::vector<SurfelGroup> WallSeen(int groups) {
  std::vector<SurfelGroup> seen(static_cast<std::size_t>(groups));
  for (int g = 0; g < groups; ++g) {
    for (int i = 0; i < 16; ++i) {
      Surfel surfel;
      surfel.point_m = {2.0 + (g % 2 == 0 ? 0.01 : -0.01), 0.05 * i};
      surfel.normal = {-1.0, 0.0};
      surfel.information = kInformation;
      surfel.normal_information = 1e4;
      seen[static_cast<std::size_t>(g)].surfels.push_back(surfel);
    }
  }
  return seen;
}

constexpr AssociationGate kGate{0.02, 0.1, 0.7};

// What two groups' sightings say of how far the first is from the wall.
double ForwardInformation(const SightingTrust& trust) {
  const std::vector<SurfelGroup> groups = WallSeen(2);
  const std::vector<Pose2> poses(2);
  const Landmarks landmarks(groups, poses, kGate);
  SkylineMatrix h({0, 0, 0, 0, 0, 0});
  Eigen::VectorXd g = Eigen::VectorXd::Zero(6);
  landmarks.AddTo(poses, trust, h, g);
  return h.Diagonal(0);
}

TEST(Landmarks, CompanionsThatErrAlikeTellAsMuchAsOne) {
  // The landmarks' own offsets take half of what each group tells.
  const double alone = ForwardInformation({1e9, {}});
  EXPECT_NEAR(alone, 16 * kInformation / 2, 1e-6 * alone);
  EXPECT_NEAR(ForwardInformation({1e9, {1.0, 1.0}}), alone / 16, 1e-6 * alone);
  EXPECT_NEAR(ForwardInformation({1e9, {1.0, 0.2}}), alone / 4, 1e-6 * alone);
  EXPECT_NEAR(ForwardInformation({1e9, {4.0, 0.2}}), alone / 16, 1e-6 * alone);
}

TEST(Landmarks, ErrorsAreAsSightingsDiffer) {
  const std::vector<SurfelGroup> groups = WallSeen(8);
  const Landmarks landmarks(groups, std::vector<Pose2>(8), kGate);
  const SightingErrors errors = landmarks.ErrorsAt(std::vector<Pose2>(8));
  // Each is 1 cm from the mean of eight, one sigma and sqrt(8/7) of what is left of it; the
  // histogram's bins are a tenth of a sigma.
  EXPECT_NEAR(errors.variance_factor, 1.4826 * 1.4826 * 8.0 / 7.0, 0.15);
  EXPECT_NEAR(errors.correlation, 1.0, 1e-9);
}

// Each group sees pieces of the wall at places of its own, and draws it at an angle of its own. A
// turn of all groups changes nothing of how they fit together.
TEST(Landmarks, NothingTurnsAllGroupsAtOnce) {
  const std::vector<Pose2> poses = {{0.0, 0.0, 0.0}, {0.3, -0.2, 0.2}, {0.1, 0.5, -0.4}};
  std::vector<SurfelGroup> groups = WallSeen(3);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Motion2 seen(Inverse(poses[g]) * Pose2{0.0, 0.003 * static_cast<double>(g * g),
                                                 0.003 * static_cast<double>(g * g)});
    for (Surfel& surfel : groups[g].surfels) surfel = seen * surfel;
  }
  const Landmarks landmarks(groups, poses, kGate);
  SkylineMatrix h({0, 0, 0, 0, 0, 0, 0, 0, 0});
  Eigen::VectorXd g = Eigen::VectorXd::Zero(9);
  landmarks.AddTo(poses, {1e9, {}}, h, g);
  double torque = 0.0;
  double size = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Vector3d turned = AdjointOf(Inverse(poses[k])) * Eigen::Vector3d::UnitZ();
    const double part = g.segment<3>(3 * static_cast<Eigen::Index>(k)).dot(turned);
    torque += part;
    size += std::abs(part);
  }
  EXPECT_LT(std::abs(torque), 1e-9 * size);
}

// Eight groups see 16 pieces of a wall, a sigma before and behind it in turns; one piece three.
TEST(Landmarks, OneThatFitsWorseThanMostIsBelievedLess) {
  std::vector<SurfelGroup> groups = WallSeen(8);
  const std::vector<Pose2> poses(8);
  const SightingTrust trust{1e9, {}};
  const auto factors = [&] { return Landmarks(groups, poses, kGate).FactorsAt(poses, trust); };
  EXPECT_EQ(factors(), std::vector<double>(16, 1.0));
  for (SurfelGroup& group : groups) {
    double& x_m = group.surfels[5].point_m.x();
    x_m = 2.0 + 3.0 * (x_m - 2.0);
  }
  std::vector<double> expected(16, 1.0);
  // Chi-squares of 72 and 8, each beside four sightings like most, over 4 + 8 - 1; most: 12 / 11.
  expected[5] = (4.0 + 72.0) / (4.0 + 8.0);
  const std::vector<double> found = factors();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9) << i;
}

TEST(Landmarks, ALandmarksFactorTakesFromItsSightings) {
  const double all = ForwardInformation({1e9, {}});
  SightingTrust half{1e9, {}, std::vector<double>(16, 1.0)};
  for (std::size_t i = 0; i < 8; ++i) half.landmark_factor[i] = 1e9;
  EXPECT_NEAR(ForwardInformation(half), all / 2, 1e-6 * all);
}

}  // namespace
}  // namespace depthgrid
