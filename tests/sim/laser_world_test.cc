#include "sim/laser/laser_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "sim/laser/odometry_noise.h"
#include "tests/io/temporary_folder.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

// Where the ray from the laser crosses the segment, by Cramer's rule; infinity if it does not.
double CastPlainly(const WallSegment& wall, const Pose2& pose, double bearing_rad) {
  const Eigen::Vector2d direction(std::cos(pose.yaw_rad + bearing_rad),
                                  std::sin(pose.yaw_rad + bearing_rad));
  const Eigen::Vector2d along = wall.b_m - wall.a_m;
  const Eigen::Vector2d start = wall.a_m - pose.translation();
  const double determinant = along.x() * direction.y() - along.y() * direction.x();
  const double range = (along.x() * start.y() - along.y() * start.x()) / determinant;
  const double share = (direction.x() * start.y() - direction.y() * start.x()) / determinant;
  const bool crosses = range > 0.0 && share >= 0.0 && share <= 1.0;
  return crosses ? range : std::numeric_limits<double>::infinity();
}

TEST(LaserWorld, CastAgreesWithEachRayOnItsOwn) {
  RandomStream random(5, RandomStage::kTest);
  int beams = 0;
  int differ = 0;
  for (int world_index = 0; world_index < 40; ++world_index) {
    LaserWorld world;
    for (int i = 0; i < 30; ++i) {
      const auto draw = [&] {
        return Eigen::Vector2d(random.Uniform(-4.0, 4.0), random.Uniform(-4.0, 4.0));
      };
      world.walls.push_back({draw(), draw()});
    }
    LaserOptions options;
    options.beams = 97;
    options.field_of_view_deg = random.Uniform(20.0, 360.0);
    const Pose2 pose{random.Uniform(-3.0, 3.0), random.Uniform(-3.0, 3.0),
                     random.Uniform(-kPi, kPi)};
    const std::vector<double> cast = CastScan(world, pose, options);
    for (int i = 0; i < options.beams; ++i, ++beams) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const WallSegment& wall : world.walls) {
        nearest = std::min(
            nearest,
            CastPlainly(wall, pose, options.FirstBearingRad() + i * options.BearingStepRad()));
      }
      // Beyond the maximum both mean "nothing".
      const double a = std::min(cast[static_cast<std::size_t>(i)], options.max_range_m);
      differ += std::abs(a - std::min(nearest, options.max_range_m)) > 1e-9 ? 1 : 0;
    }
  }
  EXPECT_EQ(beams, 3880);
  EXPECT_EQ(differ, 0);
}

TEST(LaserWorld, NoRaySlipsThroughACorner) {
  LaserWorld room;
  const Eigen::Vector2d corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i < 4; ++i) room.walls.push_back({corners[i], corners[(i + 1) % 4]});
  LaserOptions options;
  options.beams = 361;  // rays go exactly into the corners
  options.field_of_view_deg = 360.0;
  for (const double range_m : CastScan(room, {}, options)) EXPECT_LE(range_m, 1.4143);
}

TEST(LaserWorld, NoiseHasItsDeclaredSigmaAndCorrelation) {
  LaserOptions options;
  options.beams = 20000;
  options.noise_relative = 0.01;
  options.noise_quadratic_per_m = 0.002;
  options.noise_correlation = 0.6;
  const double exact_m = 3.0;
  const double sigma_m = 0.01 * 3.0 + 0.002 * 9.0;
  const std::vector<double> exact(20000, exact_m);
  double sum = 0.0;
  double square = 0.0;
  double neighbour = 0.0;
  double count = 0.0;
  for (int frame = 0; frame < 10; ++frame) {
    const std::vector<double> reported = DisturbScan(exact, options, 3, frame);
    for (std::size_t i = 1; i < reported.size(); ++i) {
      const double z = (reported[i] - exact_m) / sigma_m;
      sum += z;
      square += z * z;
      neighbour += z * (reported[i - 1] - exact_m) / sigma_m;
      count += 1.0;
    }
  }
  EXPECT_NEAR(sum / count, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(square / count), 1.0, 0.01);
  EXPECT_NEAR(neighbour / count, 0.6, 0.015);
}

TEST(LaserWorld, TooNearIsZeroAndTooFarTheMaximum) {
  LaserOptions options;
  const double infinity = std::numeric_limits<double>::infinity();
  const auto reported = DisturbScan({0.2, 3.0, 7.0, infinity}, options, 1, 0);
  EXPECT_EQ(reported[0], 0.0);
  EXPECT_NEAR(reported[1], 3.0, 0.2);
  EXPECT_EQ(reported[2], options.max_range_m);
  EXPECT_EQ(reported[3], options.max_range_m);
}

TEST(LaserWorld, OutliersReportAnythingFromTheLeastRangeToTheMost) {
  LaserOptions options;
  options.outlier_share = 0.2;
  const std::vector<double> exact(20000, 3.0);
  int outliers = 0;
  double sum_m = 0.0;
  for (const double reported_m : DisturbScan(exact, options, 4, 0)) {
    if (std::abs(reported_m - 3.0) < 0.5) continue;  // noise, or an outlier like any
    EXPECT_GE(reported_m, options.min_range_m);
    EXPECT_LE(reported_m, options.max_range_m);
    sum_m += reported_m;
    ++outliers;
  }
  const double span_m = options.max_range_m - options.min_range_m;
  EXPECT_NEAR(outliers / 20000.0, 0.2 * (span_m - 1.0) / span_m, 0.01);
  const double middle_m = 0.5 * (options.min_range_m + options.max_range_m);
  EXPECT_NEAR(sum_m / outliers, (span_m * middle_m - 3.0) / (span_m - 1.0), 0.1);
}

using LaserWorldFile = TemporaryFolderTest;

TEST_F(LaserWorldFile, ReadsSegmentsAndRefusesOthers) {
  Write("world.txt", "# walls\n0 0 1 0\n\n1 0 1 2.5 # east\n");
  const LaserWorld world = ReadLaserWorld(Path("world.txt"));
  ASSERT_EQ(world.walls.size(), 2U);
  EXPECT_EQ(world.walls[1].b_m, Eigen::Vector2d(1.0, 2.5));
  Write("world.txt", "\xEF\xBB\xBF" + std::string("0 0 1 0.5\n"));
  EXPECT_EQ(ReadLaserWorld(Path("world.txt")).walls.at(0).b_m, Eigen::Vector2d(1.0, 0.5));
  Write("world.txt", "0 0 1\n");
  EXPECT_THROW(ReadLaserWorld(Path("world.txt")), InputError);
  Write("world.txt", "# nothing\n");
  EXPECT_THROW(ReadLaserWorld(Path("world.txt")), InputError);
  EXPECT_THROW(ReadLaserWorld("/nonexistent"), InputError);
  // Every read of this file fails.
  EXPECT_EQ(RefusalOf([] { ReadLaserWorld("/proc/self/mem"); }), "/proc/self/mem: cannot be read");
}

TEST(OdometryNoise, MeanErrorIsTheOneAskedFor) {
  std::vector<Pose2> truth;
  for (int i = 0; i < 900; ++i) {
    truth.push_back({2.0 * std::cos(0.01 * i), 2.0 * std::sin(0.01 * i), WrapAngle(0.01 * i)});
  }
  for (const double target_m : {0.0, 0.04, 0.375, 1.9}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      OdometryOptions options;
      options.mean_error_m = target_m;
      const std::vector<Pose2> odometry = DisturbOdometry(truth, options, seed);
      ASSERT_EQ(odometry.size(), truth.size());
      EXPECT_EQ(odometry.front(), truth.front());
      double sum_m = 0.0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        sum_m += (odometry[i].translation() - truth[i].translation()).norm();
      }
      EXPECT_NEAR(sum_m / 900.0, target_m, 1e-6 + 1e-6 * target_m);
    }
  }
}

TEST(OdometryNoise, AMeanErrorOutOfReachIsRefused) {
  std::vector<Pose2> truth;
  for (int i = 0; i < 100; ++i) truth.push_back({0.01 * i, 0.0, 0.0});
  OdometryOptions options;
  for (const double target_m : {1e-8, 90.0}) {
    options.mean_error_m = target_m;
    EXPECT_THAT(RefusalOf([&] { DisturbOdometry(truth, options, 1); }),
                testing::MatchesRegex(
                    "mean_error_m: is .*, must be 0 or from [0-9.e-]+ to [0-9.]+: what .*"));
  }
}

TEST(OdometryNoise, JitterIsWhiteInThePose) {
  const std::vector<Pose2> truth(5000, Pose2{1.0, 2.0, 0.3});
  OdometryOptions options;
  options.mean_error_m = 0.0;
  options.jitter_m = 0.003;
  options.jitter_deg = 0.1;
  const std::vector<Pose2> odometry = DisturbOdometry(truth, options, 9);
  double position = 0.0;
  double yaw = 0.0;
  for (const Pose2& pose : odometry) {
    position += (pose.translation() - truth[0].translation()).squaredNorm();
    yaw += (pose.yaw_rad - 0.3) * (pose.yaw_rad - 0.3);
  }
  EXPECT_EQ(odometry.front(), truth.front());  // both begin at the same place
  EXPECT_NEAR(std::sqrt(position / 5000.0 / 2.0), 0.003, 0.0001);
  EXPECT_NEAR(std::sqrt(yaw / 5000.0), RadFromDeg(0.1), RadFromDeg(0.004));
}

}  // namespace
}  // namespace depthgrid
