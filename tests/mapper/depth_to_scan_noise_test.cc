// WithNoise depth images: walls stay where they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/rng.h"
#include "mapper/scan/depth_to_scan.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

// z noise of standard deviation(z), independent in each pixel.
template <typename Sigma>
DepthImage WithNoise(const DepthImage& image, RandomStream& random, Sigma sigma_m) {
  DepthImage noisy = image;
  for (float& z_m : noisy.z_m) z_m += static_cast<float>(sigma_m(z_m) * random.Normal());
  return noisy;
}

struct Bias {
  double mean_m = 0.0;
  double sigma_m = 0.0;
  int beams = 0;
};

Bias BiasOf(const Scan& scan, double wall_x_m) {
  Bias bias;
  double sum = 0.0, squares = 0.0;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit || std::abs(beam.bearing_rad) > 0.5) continue;
    const double error_m = beam.range_m - wall_x_m / std::cos(beam.bearing_rad);
    sum += error_m;
    squares += error_m * error_m;
    ++bias.beams;
  }
  bias.mean_m = sum / bias.beams;
  bias.sigma_m = std::sqrt(squares / bias.beams - bias.mean_m * bias.mean_m);
  return bias;
}

// The minimum of a column of Nguyen's noise at 4 m lies 75 mm before the wall; the scan must not.
// At 5.2 m the outer beams are 7 cm short of the reach.
TEST(DepthToScan, NoiseDoesNotPullWallsNearer) {
  const PinholeCamera camera;
  const DepthToScan converter(camera, {});
  const auto kinect = [](double z) { return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4); };
  const auto d435 = [](double z) { return 0.00377 * z * z; };
  const auto flight_time = [](double) { return 0.005; };
  RandomStream random(1, RandomStage::kTest);
  const auto check = [&](const auto& sigma_m) {
    for (const double wall_m : {1.0, 2.0, 3.0, 4.0, 5.2}) {
      for (const double pitch_deg : {0.0, 15.0}) {
        const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(pitch_deg), 0.0);
        const DepthImage image =
            WithNoise(RoomWithWallAt(wall_m).Render(camera, pose), random, sigma_m);
        const Bias bias = BiasOf(converter.Convert(image, pose), wall_m);
        EXPECT_GT(bias.beams, 500);
        // 1 mm is a fiftieth of a cell; the scatter is that of a mean over tens of pixels. At the
        // band's edges samples that noise made farther lie outside: sigma^2 / range at most.
        const double far_m = wall_m / std::cos(0.5);
        const double edges_m = sigma_m(far_m) * sigma_m(far_m) / far_m;
        EXPECT_NEAR(bias.mean_m, 0.0, std::max(0.001, edges_m))
            << wall_m << " m " << pitch_deg << " deg";
        EXPECT_LT(bias.sigma_m, 0.1 * sigma_m(wall_m)) << wall_m << " m " << pitch_deg << " deg";
      }
    }
  };
  check(kinect);
  check(d435);
  check(flight_time);
}

// Of an image that shows nothing nearer than 4 m nothing nearer was measured: what lies there is
// taken to be as noisy, not as a Kinect's.
TEST(NoiseWindow, NearerThanAnythingMeasuredItIsThatOfTheNearest) {
  RandomStream random(2, RandomStage::kTest);
  const PinholeCamera camera;
  DepthImage wall(camera.width_px, camera.height_px);
  std::fill(wall.z_m.begin(), wall.z_m.end(), 4.25F);
  const NoiseWindow window(WithNoise(wall, random, [](double z) { return 0.004 * z * z; }));
  EXPECT_NEAR(window.SigmaM(4.25) / (4.25 * 4.25), 0.004, 0.0005);
  EXPECT_NEAR(window.SigmaM(1.0), 0.004, 0.0005);
}

// A wall behind uprights of 24 columns each: of the threes of pixels over seven columns a quarter
// would see both.
TEST(NoiseWindow, OfFewColumnsEdgesAreNoNoise) {
  RandomStream random(4, RandomStage::kTest);
  DepthImage uprights(160, 120);
  for (int v = 0; v < uprights.height_px; ++v) {
    for (int u = 0; u < uprights.width_px; ++u) uprights.Row(v)[u] = u / 24 % 2 == 0 ? 3.1F : 3.4F;
  }
  const NoiseWindow window(WithNoise(uprights, random, [](double z) { return 0.002 * z * z; }));
  EXPECT_NEAR(window.SigmaM(3.25) / (3.25 * 3.25), 0.002, 0.0005);
}

// Of a wall beyond the reach the returns that noise made short of it are no wall.
TEST(DepthToScan, NoiseDoesNotPullWallsIntoTheReach) {
  const PinholeCamera camera;
  const ScanOptions options;
  const DepthToScan converter(camera, options);
  RandomStream random(3, RandomStage::kTest);
  const auto sigma_m = [](double z) { return 0.0015 * z * z; };
  const double wall_m = options.max_range_m + sigma_m(options.max_range_m);
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, 0.0, 0.0);
  const Scan scan = converter.Convert(
      WithNoise(RoomWithWallAt(wall_m).Render(camera, pose), random, sigma_m), pose);
  int hits = 0, clear = 0;
  for (const Beam& beam : scan.beams) {
    hits += beam.hit ? 1 : 0;
    clear += !beam.hit && beam.clear_to_m == static_cast<float>(options.max_range_m) ? 1 : 0;
    EXPECT_TRUE(beam.hit || beam.range_m == 0.0F);
  }
  EXPECT_EQ(hits, 0);
  EXPECT_EQ(clear, static_cast<int>(scan.beams.size()));
}

// 1/8 pixel disparities with a jitter of 1/6 step (Handa): at 3 m the steps are 25 mm apart, and
// where a wall lies between two of them the few pixels that say the nearer one must not win.
TEST(DepthToScan, RoundedDepthIsAveraged) {
  const PinholeCamera camera;
  const DepthToScan converter(camera, {});
  RandomStream random(2, RandomStage::kTest);
  const Pose3 pose = TiltedCamera({0.0, 0.0, 0.2}, kCameraHeightM, 0.05, 0.0);
  DepthImage image = RoomWithWallAt(3.0).Render(camera, pose);
  for (float& z_m : image.z_m) {
    const double disparity = std::floor(351.30 / z_m + random.Normal() / 6.0 + 0.5);
    z_m = static_cast<float>(351.30 / disparity);
  }
  double sum = 0.0, squares = 0.0;
  int beams = 0;
  for (const Beam& beam : converter.Convert(image, pose).beams) {
    const double error_m = beam.range_m - 3.0 / std::cos(beam.bearing_rad + 0.2);
    if (!beam.hit || std::abs(beam.bearing_rad) > 0.5) continue;
    sum += error_m;
    squares += error_m * error_m;
    ++beams;
  }
  EXPECT_GT(beams, 500);
  EXPECT_NEAR(sum / beams, 0.0, 0.001);
  EXPECT_LT(std::sqrt(squares / beams), 0.004);
}

}  // namespace
}  // namespace depthgrid
