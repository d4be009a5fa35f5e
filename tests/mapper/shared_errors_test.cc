#include "mapper/surfel/shared_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/rng.h"
#include "mapper/surfel/surfel_matcher.h"

namespace depthgrid {
namespace {

Surfel Facing(double degrees) {
  Surfel surfel;
  surfel.normal = {std::cos(RadFromDeg(degrees)), std::sin(RadFromDeg(degrees))};
  return surfel;
}

TEST(SharedErrors, CompanionsAreOfOneStretchAndFaceTheSameWay) {
  std::vector<Surfel> surfels(18, Facing(0.0));
  surfels[3] = Facing(10.0);
  surfels[5] = Facing(90.0);
  surfels[7] = Facing(180.0);  // the wall's other side
  surfels[9] = Facing(85.0);
  std::vector<int> companies;
  CountCompanions(surfels, companies);
  EXPECT_EQ(companies[0], 13);
  EXPECT_EQ(companies[3], 13);
  EXPECT_EQ(companies[5], 2);
  EXPECT_EQ(companies[7], 1);
  EXPECT_EQ(companies[9], 2);
  EXPECT_EQ(companies[16], 2);  // the second stretch has two
  EXPECT_EQ(companies[17], 2);
}

// Each stretch errs by something of its own beside what each surfel errs by alone.
double CorrelationFound(double shared_share, bool two_walls) {
  RandomStream random(1, RandomStage::kTest);
  SharedErrors errors;
  for (int group = 0; group < 400; ++group) {
    std::vector<Surfel> surfels;
    std::vector<double> residuals;
    const double shared = std::sqrt(shared_share) * random.Normal();
    const double shared_by_second = std::sqrt(shared_share) * random.Normal();
    for (int i = 0; i < 16; ++i) {
      const bool second = two_walls && i % 2 == 1;
      surfels.push_back(Facing(second ? 90.0 : 0.0));
      const double alone = std::sqrt(1.0 - shared_share) * random.Normal();
      residuals.push_back(alone + (second ? shared_by_second : shared));
    }
    residuals[4] = 0.0;   // not seen by another group
    residuals[6] *= 1e6;  // a wrong association
    errors.Add(surfels, residuals);
  }
  return errors.Correlation();
}

TEST(SharedErrors, CorrelationIsTheShareThatIsShared) {
  EXPECT_NEAR(CorrelationFound(0.0, false), 0.0, 0.02);
  EXPECT_NEAR(CorrelationFound(0.5, false), 0.5, 0.05);
  EXPECT_NEAR(CorrelationFound(0.5, true), 0.5, 0.05);
  EXPECT_NEAR(CorrelationFound(1.0, false), 1.0, 1e-9);
}

TEST(SharedErrors, NothingIsToldOfFewPairsOrWhatErrsTheOtherWay) {
  SharedErrors few;
  const std::vector<Surfel> two(2, Facing(0.0));
  for (int i = 0; i < 99; ++i) few.Add(two, std::vector<double>{1.0, 1.0});
  EXPECT_EQ(few.Correlation(), 0.0);
  few.Add(two, std::vector<double>{1.0, 1.0});
  EXPECT_NEAR(few.Correlation(), 1.0, 1e-9);
  SharedErrors against;
  for (int i = 0; i < 200; ++i) against.Add(two, std::vector<double>{1.0, -2.0});
  EXPECT_EQ(against.Correlation(), 0.0);
}

// Sixteen pieces across the view, known to 1 cm.
std::vector<Surfel> FlatWall() {
  std::vector<Surfel> wall(16);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    wall[i].point_m = {2.0, 0.1 * static_cast<double>(i)};
    wall[i].normal = {-1.0, 0.0};
    wall[i].information = 1e4;
    wall[i].normal_information = 1e4;
  }
  return wall;
}

SurfelStore MapOfPieces(const std::vector<Surfel>& pieces) {
  SurfelStore map;
  for (const Surfel& piece : pieces) map.Merge(piece, {0.03, 0.05, 0.7});
  return map;
}

// Sixteen pieces of one wall that all err alike tell as much as one, in the same place.
TEST(SharedErrors, MatchOfCompanionsIsBelievedLess) {
  const std::vector<Surfel> wall = FlatWall();
  const SurfelStore map = MapOfPieces(wall);
  Prediction prediction;
  prediction.map_from_base = {0.01, 0.0, 0.0};
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  SurfelMatcher matcher({});
  const MatchResult alone = matcher.Match(wall, map, prediction);
  matcher.ShareErrors(1.0);
  const MatchResult alike = matcher.Match(wall, map, prediction);
  EXPECT_NEAR(alone.information(0, 0), 16 * 5000.0, 1.0);
  EXPECT_NEAR(alike.information(0, 0), 5000.0, 1.0);
  EXPECT_NEAR(alike.map_from_base.x_m, alone.map_from_base.x_m, 1e-5);
  SurfelMatchOptions off;
  off.judge_sharing = false;
  SurfelMatcher believing(off);
  believing.ShareErrors(1.0);
  EXPECT_EQ(believing.Match(wall, map, prediction).information, alone.information);
}

// Pieces of a wall across the view that err by 1 cm and 0.05 rad, and claim to err by `claimed` of
// that.
std::vector<Surfel> NoisyWall(RandomStream& random, double claimed) {
  constexpr double kOffM = 0.01;
  constexpr double kOffRad = 0.05;
  std::vector<Surfel> wall(100);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const double off_rad = kOffRad * random.Normal();
    wall[i].point_m = {2.0 + kOffM * random.Normal(), 0.05 * static_cast<double>(i) - 2.5};
    wall[i].normal = {-std::cos(off_rad), std::sin(off_rad)};
    wall[i].information = 1.0 / (claimed * claimed * kOffM * kOffM);
    wall[i].normal_information = 1.0 / (claimed * claimed * kOffRad * kOffRad);
  }
  return wall;
}

TEST(SurfelMatcher, NoiseBeyondWhatIsClaimedTellsNothingAlongAWall) {
  RandomStream random(7, RandomStage::kTest);
  Prediction prediction;
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  for (const double claimed : {1.0, 0.125}) {
    for (int i = 0; i < 20; ++i) {
      const SurfelStore map = MapOfPieces(NoisyWall(random, claimed));
      SurfelMatcher matcher({});
      matcher.SetBeamsErrAlike(true);
      const MatchResult match = matcher.Match(NoisyWall(random, claimed), map, prediction);
      ASSERT_TRUE(match.found);
      EXPECT_GT(match.information(0, 0), 1e5) << claimed;
      // The normals alone feign 0.05^2.
      EXPECT_LT(match.information(1, 1), 5e-4 * match.information(0, 0)) << claimed;
    }
  }
}

// A map drawn at poses some millimetres off misfits as well, though its walls face as they should.
// Four pieces that face sideways then still tell the position along the wall.
TEST(SurfelMatcher, AMapThatIsOffStillTellsThePositionAlongAWall) {
  RandomStream random(7, RandomStage::kTest);
  constexpr double kOffSigmas = 6.0;
  constexpr double kSigmaM = 1e-3;
  const auto seen = [](Eigen::Vector2d point_m, Eigen::Vector2d normal) {
    Surfel surfel;
    surfel.point_m = point_m;
    surfel.normal = normal;
    surfel.information = 1.0 / (kSigmaM * kSigmaM);
    surfel.normal_information = 1.0 / (0.03 * 0.03);
    return surfel;
  };
  std::vector<Surfel> scan;
  for (int i = 0; i < 100; ++i) scan.push_back(seen({2.0, 0.05 * i - 2.5}, {-1.0, 0.0}));
  for (int i = 0; i < 4; ++i) scan.push_back(seen({1.5 + 0.1 * i, 2.5}, {0.0, -1.0}));
  std::vector<Surfel> drawn = scan;
  for (Surfel& surfel : drawn) {
    surfel.point_m += kOffSigmas * kSigmaM * random.Normal() * surfel.normal;
  }
  const SurfelStore map = MapOfPieces(drawn);
  Prediction prediction;
  prediction.covariance = Eigen::Vector3d(1e-2, 1e-2, 1e-4).asDiagonal();
  SurfelMatcher matcher({});
  const MatchResult match = matcher.Match(scan, map, prediction);
  ASSERT_TRUE(match.found);
  // A quarter of what four pieces six sigmas off would tell, or more.
  EXPECT_GT(match.information(1, 1), 0.5 * 4.0 * 0.5 / (36.0 * kSigmaM * kSigmaM));
  // What errs so by noise has normals that err by as much more, and a hundred of them feign most.
  matcher.SetBeamsErrAlike(true);
  EXPECT_LT(matcher.Match(scan, map, prediction).information(1, 1), 0.5 * match.information(1, 1));
}

// Far from the minimum all residuals are large, and none of that is misfit.
TEST(SurfelMatcher, AWrongPredictionIsNoMisfit) {
  const std::vector<Surfel> wall = FlatWall();
  const SurfelStore map = MapOfPieces(wall);
  Prediction prediction;
  prediction.map_from_base = {0.05, 0.0, 0.0};  // five sigmas off
  prediction.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  for (const int iterations : {1, 2, 3, 10}) {
    SurfelMatchOptions options;
    options.max_iterations = iterations;
    const MatchResult match = SurfelMatcher(options).Match(wall, map, prediction);
    ASSERT_TRUE(match.found);
    EXPECT_NEAR(match.map_from_base.x_m, 0.0, 5e-4) << iterations;
    // Judged where it began, it would be a ninth of this.
    if (iterations >= 3) {
      EXPECT_NEAR(match.information(0, 0), 16 * 5000.0, 800.0);
    }
  }
}

}  // namespace
}  // namespace depthgrid
