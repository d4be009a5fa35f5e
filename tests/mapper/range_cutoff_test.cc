#include "mapper/surfel/range_cutoff.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/surfel/scan_surfels.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

TEST(RangeCutoff, IsWhatIsLeftOfNormalValuesBelowALimit) {
  for (const double limit : {-1.0, 0.0, 0.7, 2.0}) {
    RandomStream random(5, RandomStage::kTest);
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    for (int i = 0; i < 400000; ++i) {
      const double value = random.Normal();
      if (value > limit) continue;
      sum += value;
      squares += value * value;
      ++count;
    }
    const double mean = sum / count;
    const RangeCutoff cutoff = CutoffAt(limit);
    EXPECT_NEAR(cutoff.shortfall, -mean, 0.005) << limit;
    EXPECT_NEAR(cutoff.information, squares / count - mean * mean, 0.005) << limit;
  }
}

TEST(RangeCutoff, IsNothingFarFromTheLimit) {
  const RangeCutoff cutoff = CutoffAt(kUncutSigmas);
  EXPECT_LT(cutoff.shortfall, 1e-3);
  EXPECT_GT(cutoff.information, 0.995);
}

// The mean distance of a wall's surfels from the wall, towards the sensor.
double ShortOfWall(double wall_m, double max_range_m, bool correct) {
  PlanarLaser laser;
  laser.max_range_m = max_range_m;
  laser.sigma_of_range = 0.03;
  const PlanarWorld wall = {{{wall_m, -8.0}, {wall_m, 8.0}}};
  ScanSurfelOptions options;
  options.correct_cutoff = correct;
  options.split_chi2 = 1000.0;  // what is cut off looks bent, and short lines are corrected by less
  ScanSurfelMaker maker(options);
  RangeNoise noise;
  double weighted = 0.0;
  double weight = 0.0;
  for (std::uint32_t frame = 0; frame < 60; ++frame) {
    const Scan scan = ScanOf(wall, {}, laser, 3, frame);
    noise.Add(scan);
    for (const Surfel& surfel : maker.Make(scan, noise)) {
      weighted += surfel.information * (wall_m - surfel.point_m.x());
      weight += surfel.information;
    }
  }
  return weighted / weight;
}

// Against a sensor that sees farther: the mean of inverse ranges has a small bias of its own.
TEST(RangeCutoff, AWallNearTheReachIsWhereItIs) {
  constexpr double kFarReachM = 10.0;
  constexpr double kReachM = 6.0;
  for (const double wall_m : {5.2, 5.5, 5.8}) {
    const double uncut_m = ShortOfWall(wall_m, kFarReachM, true);
    const double cut_m = ShortOfWall(wall_m, kReachM, false) - uncut_m;
    const double corrected_m = ShortOfWall(wall_m, kReachM, true) - uncut_m;
    EXPECT_GT(cut_m, 0.01) << wall_m;
    EXPECT_LT(std::abs(corrected_m), 0.2 * cut_m) << wall_m;
  }
}

// The first that a precise camera sees: the far end of a slanting wall. Corrected with the noise of
// a cheap scanner, which is what is assumed at first, the wall was turned by degrees.
TEST(RangeCutoff, TheFarEndOfAWallIsNotTurnedBeforeTheNoiseIsLearnt) {
  constexpr double kWallM = 5.2;
  constexpr double kNormalRad = 0.96;  // seen beyond 25 degrees to the left, to the view's edge
  const Eigen::Vector2d normal(std::cos(kNormalRad), std::sin(kNormalRad));
  const Eigen::Vector2d along(-normal.y(), normal.x());
  PlanarLaser laser;
  laser.sigma_of_range = 0.001;
  ScanSurfelMaker maker({});
  RangeNoise noise;
  double turned_rad = 0.0;
  int count = 0;
  for (std::uint32_t frame = 0; frame < 8; ++frame) {
    const Scan scan = ScanOf({{kWallM * normal - 9.0 * along, kWallM * normal + 9.0 * along}}, {},
                             laser, 3, frame);
    noise.Add(scan);
    for (const Surfel& surfel : maker.Make(scan, noise)) {
      turned_rad += std::abs(surfel.normal.dot(along));
      ++count;
    }
  }
  ASSERT_GT(count, 20);
  EXPECT_LT(turned_rad / count, 0.005);
}

double InformationOf(const Scan& scan, const RangeNoise& noise) {
  double sum = 0.0;
  for (const Surfel& surfel : ScanSurfelMaker({}).Make(scan, noise)) sum += surfel.information;
  return sum;
}

// Two beams of five are short enough to be seen, and make lines.
TEST(RangeCutoff, OfAWallBeyondTheReachLittleIsLeft) {
  PlanarLaser laser;
  laser.sigma_of_range = 0.03;
  RangeNoise noise;
  noise.Add(ScanOf({{{4.0, -8.0}, {4.0, 8.0}}}, {}, laser, 4));
  double known = 0.0;
  double unknown = 0.0;
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    Scan scan = ScanOf({{{6.05, -8.0}, {6.05, 8.0}}}, {}, laser, 3, frame);
    known += InformationOf(scan, noise);
    scan.max_range_m = 0.0;  // a scan that does not say how far its sensor sees
    unknown += InformationOf(scan, noise);
  }
  EXPECT_GT(unknown, 0.0);
  EXPECT_LT(known, 0.2 * unknown);
}

}  // namespace
}  // namespace depthgrid
