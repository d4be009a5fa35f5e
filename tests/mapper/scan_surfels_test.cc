#include "mapper/surfel/scan_surfels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "mapper/core/median.h"
#include "mapper/core/rng.h"
#include "mapper/surfel/range_noise.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

TEST(ScanSurfels, LieOnTheWallsAndFaceTheSensorWithoutNoise) {
  PlanarWorld room = RectangleWorld(-2.0, -2.5, 3.0, 2.5);
  for (const Wall& wall : RectangleWorld(1.5, 0.4, 2.2, 1.1)) room.push_back(wall);
  const Scan scan = ScanOf(room, {}, {});
  RangeNoise noise;
  noise.Add(scan);
  const std::vector<Surfel> surfels = ScanSurfelMaker({}).Make(scan, noise);
  ASSERT_GT(surfels.size(), 40U);
  for (const Surfel& surfel : surfels) {
    const double off_east = std::abs(surfel.point_m.x() - 3.0);
    const double off_box =
        std::min(std::abs(surfel.point_m.x() - 1.5), std::abs(surfel.point_m.y() - 0.4));
    EXPECT_LT(std::min(off_east, off_box), 1e-3);
    EXPECT_LT(surfel.normal.dot(surfel.point_m), 0.0);
  }
}

TEST(ScanSurfels, ErrHasTheDeclaredSigma) {
  const PlanarWorld wall = {{{2.0, -4.0}, {2.0, 4.0}}};
  RangeNoise noise;
  ScanSurfelMaker maker({});
  double squares = 0.0;
  double count = 0.0;
  for (std::uint32_t frame = 0; frame < 300; ++frame) {
    const Scan scan = ScanOf(wall, {0.0, 0.0, 0.4}, {.sigma_of_range = 0.01}, 3, frame);
    noise.Add(scan);
    for (const Surfel& surfel : maker.Make(scan, noise)) {
      const Eigen::Vector2d in_world = Motion2({0.0, 0.0, 0.4}) * surfel.point_m;
      const double error_m = in_world.x() - 2.0;
      squares += error_m * error_m * surfel.information;
      count += 1.0;
    }
  }
  EXPECT_GT(count, 20000.0);
  EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.1);
}

// A slanted wall, against itself: noise that also moved pieces along it would turn the match.
TEST(ScanSurfels, NoiseDoesNotTurnAMatch) {
  const PlanarWorld wall = {{{2.0, -20.0}, {2.0, 20.0}}};
  const Motion2 turn({0.0, 0.0, 0.6});
  constexpr std::uint32_t kScans = 3000;
  RangeNoise noise;
  ScanSurfelMaker maker({});
  std::vector<double> xs;
  std::vector<double> ys;
  for (std::uint32_t frame = 0; frame < kScans; ++frame) {
    const Scan scan = ScanOf(wall, {0.0, 0.0, 0.6}, {.sigma_of_range = 0.03}, 3, frame);
    noise.Add(scan);
    for (const Surfel& surfel : maker.Make(scan, noise)) {
      const Eigen::Vector2d in_world = turn * surfel.point_m;
      xs.push_back(in_world.x());
      ys.push_back(in_world.y());
    }
  }
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const double mean_x = mean(xs);
  const double mean_y = mean(ys);
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    xx += (xs[i] - mean_x) * (xs[i] - mean_x);
    xy += (xs[i] - mean_x) * (ys[i] - mean_y);
    yy += (ys[i] - mean_y) * (ys[i] - mean_y);
  }
  // Independent, their correlation is within three standard deviations of 0.
  EXPECT_NEAR(xy / std::sqrt(xx * yy), 0.0, 3.0 / std::sqrt(static_cast<double>(xs.size())));
}

// Before a wall a post with an edge towards the laser, hit by too few beams to be cut in two.
TEST(ScanSurfels, OfWhatIsNoLineAreBelievedLess) {
  PlanarWorld world = {{{2.0, -4.0}, {2.0, 4.0}}};
  world.push_back({{1.04, -0.006}, {1.0, 0.0}});
  world.push_back({{1.0, 0.0}, {1.04, 0.006}});
  RangeNoise noise;
  ScanSurfelOptions options;
  options.edge_misfit = 0.0;
  ScanSurfelOptions blind_options = options;
  blind_options.judge_fit = false;
  ScanSurfelMaker judging(options);
  ScanSurfelMaker blind(blind_options);
  std::vector<double> on_wall;
  std::vector<double> on_post;
  for (std::uint32_t frame = 0; frame < 40; ++frame) {
    const Scan scan = ScanOf(world, {}, {.sigma_of_range = 0.0005}, 5, frame);
    noise.Add(scan);
    const std::vector<Surfel> judged = judging.Make(scan, noise);
    const std::vector<Surfel> claimed = blind.Make(scan, noise);
    ASSERT_EQ(judged.size(), claimed.size());
    for (std::size_t i = 0; i < judged.size(); ++i) {
      const double factor = claimed[i].information / judged[i].information;
      EXPECT_GE(factor, 1.0 - 1e-12);
      EXPECT_NEAR(claimed[i].normal_information / judged[i].normal_information, factor, 1e-9);
      (judged[i].point_m.x() < 1.5 ? on_post : on_wall).push_back(factor);
    }
  }
  ASSERT_GT(on_post.size(), 10U);
  EXPECT_GT(UpperMedian(on_post), 20.0);
  EXPECT_LT(UpperMedian(on_wall), 1.2);
}

constexpr double kPanelBeamRad = 0.0016;

// A panel of 300 beams 3.6 m away with gaps of two beams through which the wall 0.15 m behind it is
// seen, and beside it a wall of 40 beams that recedes at 84 to 87 degrees of incidence.
Scan PanelWithGaps(std::uint64_t seed) {
  Scan scan;
  RandomStream random(seed, RandomStage::kTest);
  const auto add = [&](double range_m) {
    const double bearing_rad = kPanelBeamRad * static_cast<double>(scan.beams.size());
    const auto noisy_m = static_cast<float>(range_m + 0.01 * random.Normal());
    scan.beams.push_back({static_cast<float>(bearing_rad), noisy_m, 0.0F, noisy_m, true});
  };
  for (int i = 0; i < 300; ++i) add(i % 25 == 11 || i % 25 == 12 ? 3.75 : 3.6);
  for (int i = 0; i < 40; ++i) add(1.0 / (1.0 / 3.6 - 0.004 * i));
  return scan;
}

TEST(ScanSurfels, BeamsOnBothSidesOfAnEdgeAreNoWall) {
  RangeNoise noise;
  for (std::uint64_t seed = 0; seed < 30; ++seed) noise.Add(PanelWithGaps(seed));
  ASSERT_EQ(noise.stride(), 1);
  ScanSurfelOptions options;
  const auto along_beams = [&](int from, int to) {
    int count = 0;
    for (std::uint64_t seed = 100; seed < 120; ++seed) {
      for (const Surfel& surfel : ScanSurfelMaker(options).Make(PanelWithGaps(seed), noise)) {
        const double bearing_rad = std::atan2(surfel.point_m.y(), surfel.point_m.x());
        if (bearing_rad < kPanelBeamRad * from || bearing_rad >= kPanelBeamRad * to) continue;
        count += std::abs(surfel.normal.dot(surfel.point_m.normalized())) < 0.5 ? 1 : 0;
      }
    }
    return count;
  };
  const int left = along_beams(0, 280);
  const int on_wall = along_beams(300, 340);
  options.edge_misfit = 0.0;
  const int all = along_beams(0, 280);
  EXPECT_GT(all, 100);
  EXPECT_LT(left, 0.25 * all);
  EXPECT_GT(on_wall, 300);
  EXPECT_EQ(on_wall, along_beams(300, 340));
}

// A ring of so few beams that one line is laid through the walls all round.
TEST(ScanSurfels, NoWallGoesHalfRoundTheSensor) {
  for (const int beams : {4, 5, 6, 7}) {
    for (const double max_range_m : {0.0, 8.0, 2.05}) {
      Scan ring;
      ring.max_range_m = max_range_m;
      for (int i = 0; i < beams; ++i) {
        const double bearing_rad = 2.0 * kPi * i / beams - kPi;
        ring.beams.push_back({static_cast<float>(bearing_rad), 2.0F, 0.0F, 2.0F, true});
      }
      EXPECT_TRUE(ScanSurfelMaker({}).Make(ring, RangeNoise()).empty()) << beams;
    }
  }
}

// Lines through ranges that are on none may run along the last of their beams.
TEST(ScanSurfels, NoWallGoesOnBeyondAllSight) {
  int made = 0;
  for (std::uint32_t frame = 0; frame < 5000; ++frame) {
    RandomStream random(1, RandomStage::kTest, frame);
    Scan ring;
    for (int i = 0; i < 8; ++i) {
      const auto range_m = static_cast<float>(random.Uniform(0.5, 5.0));
      ring.beams.push_back({static_cast<float>(0.25 * kPi * i - kPi), range_m, 0.0F, 0.0F, true});
    }
    for (const Surfel& surfel : ScanSurfelMaker({}).Make(ring, RangeNoise())) {
      EXPECT_LT(surfel.point_m.norm(), kFarthestSeenM) << frame;
      ++made;
    }
  }
  EXPECT_GT(made, 1000);
}

}  // namespace
}  // namespace depthgrid
