#include "sim/depth/sensor_artifacts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/depth/depth_noise.h"
#include "tests/sim/test_frames.h"

namespace depthgrid {
namespace {

using test::Constant;
using test::Options;
using test::PlaneFrame;

TEST(ProjectorShadow, IsAsWideAsTheDifferenceOfDisparities) {
  // A near strip before a wall: what the projector, to the right, does not reach lies to its left.
  SensorOptions options = Options(DepthNoiseModel::kNone);
  options.shadow_baseline_m = 0.075;
  DepthFrame clean = Constant(3.0, 0.0);
  for (int v = 0; v < 480; ++v) std::fill_n(clean.depth.Row(v) + 300, 100, 1.0F);
  const double band_px = 481.20 * 0.075 * (1.0 / 1.0 - 1.0 / 3.0);  // 24.06
  const DepthImage seen = DepthNoise(options).Apply(clean, 1, 0);
  const auto dark_from = [&](int u) {
    int count = 0;
    while (u >= 0 && seen.At(u, 100) == kInvalidDepth) {
      ++count;
      --u;
    }
    return count;
  };
  EXPECT_NEAR(dark_from(299), band_px, 1.0);
  EXPECT_EQ(std::count(seen.Row(100), seen.Row(100) + 640, kInvalidDepth), dark_from(299));
  // The other way round the shadow falls to the right.
  options.shadow_baseline_m = -0.075;
  const DepthImage mirrored = DepthNoise(options).Apply(clean, 1, 0);
  EXPECT_EQ(mirrored.At(400, 100), kInvalidDepth);
  EXPECT_NE(mirrored.At(299, 100), kInvalidDepth);
}

TEST(ProjectorShadow, OfAThinPoleStandsApartFromIt) {
  SensorOptions options = Options(DepthNoiseModel::kNone);
  options.shadow_baseline_m = 0.075;
  DepthFrame clean = Constant(3.0, 0.0);
  for (int v = 0; v < 480; ++v) std::fill_n(clean.depth.Row(v) + 300, 6, 1.0F);
  const DepthImage seen = DepthNoise(options).Apply(clean, 1, 0);
  EXPECT_NE(seen.At(299, 100), kInvalidDepth);  // lit past the pole
  EXPECT_EQ(seen.At(279, 100), kInvalidDepth);
  EXPECT_NEAR(static_cast<double>(std::count(seen.Row(100), seen.Row(100) + 640, kInvalidDepth)),
              6.0, 1.0);
}

TEST(ProjectorShadow, LeavesSlantedSurfacesLit) {
  SensorOptions options = Options(DepthNoiseModel::kNone);
  options.shadow_baseline_m = 0.075;
  for (const double turn_deg : {-60.0, 0.0, 60.0}) {
    const DepthFrame clean = PlaneFrame(2.0, turn_deg);
    const DepthImage seen = DepthNoise(options).Apply(clean, 1, 0);
    EXPECT_EQ(seen.z_m, clean.depth.z_m) << turn_deg;
  }
}

}  // namespace
}  // namespace depthgrid
