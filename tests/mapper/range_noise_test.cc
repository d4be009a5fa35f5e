// Errors that neighbouring beams share, and those that a sensor's reach hides.
#include "mapper/surfel/range_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/median.h"
#include "mapper/core/rng.h"
#include "mapper/surfel/scan_surfels.h"
#include "tests/mapper/planar_world.h"

namespace depthgrid {
namespace {

constexpr int kBeams = 640;
constexpr double kStepRad = 0.0017;
constexpr double kRangeM = 3.0;
constexpr double kRelativeSigma = 0.01;  // of the range

// A wall across the view; errors are correlated by exp(-(d / length)^2 / 2), 0: not.
Scan WallWithNoise(RandomStream& random, double length, double sigma = kRelativeSigma) {
  constexpr int kReach = 40;
  std::vector<double> white(kBeams + 2 * kReach);
  for (double& value : white) value = random.Normal();
  Scan scan;
  for (int i = 0; i < kBeams; ++i) {
    double sum = 0.0, squares = 0.0;
    for (int d = -kReach; d <= kReach; ++d) {
      const double weight = length > 0.0 ? std::exp(-d * d / (length * length))
                            : d == 0     ? 1.0
                                         : 0.0;
      sum += weight * white[static_cast<std::size_t>(i + kReach + d)];
      squares += weight * weight;
    }
    const double bearing_rad = (i - 0.5 * (kBeams - 1)) * kStepRad;
    const double range_m =
        kRangeM / std::cos(bearing_rad) * (1.0 + sigma * sum / std::sqrt(squares));
    Beam beam;
    beam.bearing_rad = static_cast<float>(bearing_rad);
    beam.range_m = static_cast<float>(range_m);
    beam.hit = true;
    scan.beams.push_back(beam);
  }
  return scan;
}

TEST(RangeNoise, BeamsThatErrByThemselvesAllCount) {
  RandomStream random(1, RandomStage::kTest);
  RangeNoise noise;
  for (int i = 0; i < 40; ++i) {
    noise.Add(WallWithNoise(random, 0.0));
    EXPECT_EQ(noise.stride(), 1) << i;
  }
  EXPECT_NEAR(noise.RelativeSigma(kRangeM), kRelativeSigma, 0.1 * kRelativeSigma);
}

// The longest ranges of a wall near the sensor's reach are missing, so what is left differs less.
TEST(RangeNoise, IsTheSameNearTheSensorsReach) {
  constexpr double kRelative = 0.03;
  PlanarLaser laser;
  laser.max_range_m = 6.0;
  laser.sigma_of_range = kRelative;
  RangeNoise noise;
  for (std::uint32_t frame = 0; frame < 240; ++frame) {
    const double wall_m = 4.0 + 0.01 * frame;
    noise.Add(ScanOf({{{wall_m, -8.0}, {wall_m, 8.0}}}, {}, laser, 3, frame));
  }
  EXPECT_NEAR(noise.RelativeSigma(4.0), kRelative, 0.04 * kRelative);
  EXPECT_NEAR(noise.RelativeSigma(5.9), kRelative, 0.04 * kRelative);
}

// The value to begin with is ten times as large here: with it, all of this wall would count as so
// near the reach that its longest ranges may be missing, and nothing would ever be learnt.
TEST(RangeNoise, IsLearntFromAWallAtTheReachAlone) {
  constexpr double kRelative = 0.001;
  PlanarLaser laser;
  laser.max_range_m = 6.0;
  laser.sigma_of_range = kRelative;
  RangeNoise noise;
  for (std::uint32_t frame = 0; frame < 20; ++frame) {
    noise.Add(ScanOf({{{5.95, -8.0}, {5.95, 8.0}}}, {}, laser, 3, frame));
  }
  EXPECT_TRUE(noise.TellsCutoff());
  EXPECT_NEAR(noise.RelativeSigma(5.95), kRelative, 0.2 * kRelative);
}

TEST(RangeNoise, OfBeamsThatErrAlikeOnlySomeCount) {
  for (const auto& [length, stride] : {std::pair{1.5, 2}, {3.0, 4}, {6.0, 8}}) {
    RandomStream random(2, RandomStage::kTest);
    RangeNoise noise, all(false);
    for (int i = 0; i < 40; ++i) {
      const Scan scan = WallWithNoise(random, length);
      noise.Add(scan);
      all.Add(scan);
    }
    EXPECT_EQ(noise.stride(), stride) << length;
    EXPECT_EQ(all.stride(), 1) << length;
    EXPECT_NEAR(noise.RelativeSigma(kRangeM), kRelativeSigma, 0.4 * kRelativeSigma) << length;
    EXPECT_LT(all.RelativeSigma(kRangeM), 0.4 * kRelativeSigma) << length;
  }
}

// Between neighbours less shows then than any sensor is believed to err by.
TEST(RangeNoise, OfBeamsThatErrVerySmoothlyFewCount) {
  for (const auto& [length, sigma] : {std::pair{12.0, 0.01}, {6.0, 0.003}, {10.0, 0.003}}) {
    RandomStream random(4, RandomStage::kTest);
    RangeNoise noise;
    for (int i = 0; i < 40; ++i) noise.Add(WallWithNoise(random, length, sigma));
    EXPECT_EQ(noise.stride(), length > 6.0 ? 16 : 8) << length;
    EXPECT_GT(noise.RelativeSigma(kRangeM), 0.2 * sigma) << length;
  }
}

// Each beam of a laser is measured alone, so what beams far apart show more of than neighbours is
// the shape of the room.
TEST(RangeNoise, WhereWallsAreCurvedAllOfALasersBeamsCount) {
  constexpr double kSigma = 0.001;
  for (const double step_deg : {0.25, 0.5, 1.0}) {
    RandomStream random(6, RandomStage::kTest);
    RangeNoise noise;
    for (int i = 0; i < 40; ++i) {
      Scan scan;
      for (double bearing_deg = -90.0; bearing_deg <= 90.0; bearing_deg += step_deg) {
        const double bearing_rad = RadFromDeg(bearing_deg);
        const double range_m = 8.0 + 1.5 * std::sin(12.0 * bearing_rad + 0.1 * i);
        Beam beam;
        beam.bearing_rad = static_cast<float>(bearing_rad);
        beam.range_m = static_cast<float>(range_m * (1.0 + kSigma * random.Normal()));
        beam.hit = true;
        scan.beams.push_back(beam);
      }
      noise.Add(scan);
      EXPECT_EQ(noise.stride(), 1) << step_deg;
    }
  }
}

// Pillars and furniture are no noise.
TEST(RangeNoise, OfALaserIsThatOfItsWalls) {
  constexpr double kSigma = 0.002;
  RandomStream random(7, RandomStage::kTest);
  RangeNoise noise;
  for (int i = 0; i < 40; ++i) {
    Scan scan;
    for (int k = 0; k < 180; ++k) {
      const double bearing_rad = RadFromDeg(k - 89.5);
      const bool on_wall = k % 60 < 40;
      const double wall_m = 4.0 / std::cos(bearing_rad - RadFromDeg(k / 60 * 60 - 77.0));
      const double step_m = std::exp(random.Uniform(std::log(0.003), std::log(3.0)));
      const double range_m = on_wall ? wall_m : 3.5 + step_m;
      Beam beam;
      beam.bearing_rad = static_cast<float>(bearing_rad);
      beam.range_m = static_cast<float>(range_m * (1.0 + kSigma * random.Normal()));
      beam.hit = true;
      scan.beams.push_back(beam);
    }
    noise.Add(scan);
  }
  EXPECT_NEAR(noise.RelativeSigma(4.1), kSigma, 0.5 * kSigma);
}

// What differs by less than any sensor errs by is no noise, however smooth it is.
TEST(RangeNoise, OfExactRangesAllCount) {
  RandomStream random(5, RandomStage::kTest);
  RangeNoise noise;
  for (int i = 0; i < 40; ++i) noise.Add(WallWithNoise(random, 6.0, 1e-5));
  EXPECT_EQ(noise.stride(), 1);
}

// How far off the pieces of a wall and their normals are, over what is claimed: the medians.
struct Errors {
  double point = 0.0;
  double normal = 0.0;
};
enum class Beams { kAll, kIndependent };
Errors ErrorsOfPieces(bool skips_alike, Beams beams) {
  RandomStream random(3, RandomStage::kTest);
  RangeNoise noise(skips_alike);
  ScanSurfelMaker maker({});
  std::vector<double> points, normals;
  for (int i = 0; i < 40; ++i) {
    const Scan scan = WallWithNoise(random, 6.0);
    noise.Add(scan);
    const int stride = beams == Beams::kAll ? 1 : noise.stride();
    for (const Surfel& surfel : maker.Make(scan, noise, stride)) {
      points.push_back(std::abs(surfel.point_m.x() - kRangeM) * std::sqrt(surfel.information));
      const double off_rad = std::atan2(surfel.normal.y(), -surfel.normal.x());
      normals.push_back(std::abs(off_rad) * std::sqrt(surfel.normal_information));
    }
  }
  return {kSigmaOfMedian * UpperMedian(points), kSigmaOfMedian * UpperMedian(normals)};
}

TEST(RangeNoise, LinesOfBeamsThatErrAlikeClaimWhatTheyAreWorth) {
  EXPECT_GT(ErrorsOfPieces(false, Beams::kIndependent).normal, 5.0);
  EXPECT_GT(ErrorsOfPieces(false, Beams::kIndependent).point, 5.0);
  for (const Beams beams : {Beams::kIndependent, Beams::kAll}) {
    // Beams 8 apart still share .4 of their errors.
    EXPECT_LT(ErrorsOfPieces(true, beams).normal, 3.0);
    EXPECT_LT(ErrorsOfPieces(true, beams).point, 3.0);
  }
}

}  // namespace
}  // namespace depthgrid
