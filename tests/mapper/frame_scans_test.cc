#include "mapper/scan/frame_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "mapper/core/rng.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

constexpr double kBackWallM = 4.0;
constexpr double kTableM = 2.0;
constexpr double kTableTopM = 0.9;

// A wall across the view with a table in front of it that ends below the camera's height.
std::shared_ptr<const DepthImage> WallBehindTable(const PinholeCamera& camera) {
  auto image = std::make_shared<DepthImage>(camera.width_px, camera.height_px);
  for (int v = 0; v < camera.height_px; ++v) {
    const double drop = (v - camera.cy_px) / camera.fy_px;
    const bool table = kCameraHeightM - kTableM * drop < kTableTopM;
    std::fill_n(image->Row(v), camera.width_px, static_cast<float>(table ? kTableM : kBackWallM));
  }
  return image;
}

double MeanForwardM(const Scan& scan) {
  double sum_m = 0.0;
  int hits = 0;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    sum_m += beam.range_m * std::cos(beam.bearing_rad);
    ++hits;
  }
  EXPECT_GT(hits, 600);
  return sum_m / hits;
}

Frame WallFrame() {
  Frame frame;
  frame.depth = WallBehindTable(PinholeCamera{});
  frame.slam_from_camera = CameraOf(Pose2{}, kCameraHeightM);
  return frame;
}

TEST(FrameScanner, ObstaclesAreTheNearestSurfaceAndTheSliceIsLevelWithTheCamera) {
  const FrameScans scans = FrameScanner(PinholeCamera{}, ScanOptions{}).ScansOf(WallFrame());
  EXPECT_NEAR(MeanForwardM(*scans.obstacles), kTableM, 1e-3);
  EXPECT_NEAR(MeanForwardM(*scans.matched), kBackWallM, 1e-3);
}

TEST(FrameScanner, BothScansAreThoseOfTwoConversions) {
  ScanOptions options;
  options.slice_agree_sigmas = 0.0;  // neither of which a scan of obstacles knows
  options.slice_lean_sigmas = 0.0;
  ScanOptions slice = options;
  slice.band_low_m = 0.0;
  slice.band_high_m = 2.0 * options.slice_half_height_m;
  const PinholeCamera camera;
  FrameScanner scanner(camera, options);
  for (const double pitch_rad : {-0.2, 0.0, 0.3}) {
    Frame frame = WallFrame();
    frame.slam_from_camera = TiltedCamera({}, kCameraHeightM, pitch_rad, 0.5 * pitch_rad);
    const FrameScans scans = scanner.ScansOf(frame);
    ASSERT_TRUE(scans.stand.has_value());
    CameraStand at_camera = *scans.stand;
    at_camera.height_m = options.slice_half_height_m;
    EXPECT_EQ(*scans.obstacles, DepthToScan(camera, options).Convert(*frame.depth, *scans.stand));
    EXPECT_EQ(*scans.matched, DepthToScan(camera, slice).Convert(*frame.depth, at_camera));
  }
}

// Depth as a function of the height above the camera, with noise of 6 mm.
template <typename DepthAt>
Frame NoisyFrame(const DepthAt& depth_at, std::uint64_t seed) {
  constexpr double kDepthSigmaM = 0.006;
  const PinholeCamera camera;
  RandomStream random(seed, RandomStage::kTest);
  auto image = std::make_shared<DepthImage>(camera.width_px, camera.height_px);
  for (int v = 0; v < camera.height_px; ++v) {
    const double rise = (camera.cy_px - v) / camera.fy_px;
    const double z_m = depth_at(rise);
    for (int u = 0; u < camera.width_px; ++u) {
      image->Row(v)[u] = static_cast<float>(z_m + kDepthSigmaM * random.Normal());
    }
  }
  Frame frame;
  frame.depth = image;
  frame.slam_from_camera = CameraOf(Pose2{}, kCameraHeightM);
  return frame;
}

Scan MatchedScan(const Frame& frame, double agree_sigmas) {
  ScanOptions options;
  options.floor = FloorSource::kPose;
  options.slice_agree_sigmas = agree_sigmas;
  return *FrameScanner(PinholeCamera{}, options).ScansOf(frame).matched;
}

constexpr double kAgreeSigmas = ScanOptions{}.slice_agree_sigmas;

TEST(FrameScanner, AStepAboveTheCameraDoesNotMoveTheSlice) {
  for (const double wall_m : {2.0, 3.0, 4.0}) {
    const Frame frame =
        NoisyFrame([&](double rise) { return rise * wall_m > 0.055 ? wall_m + 0.02 : wall_m; }, 1);
    EXPECT_NEAR(MeanForwardM(MatchedScan(frame, kAgreeSigmas)), wall_m, 1e-3);
    EXPECT_GT(MeanForwardM(MatchedScan(frame, 0.0)), wall_m + 2.5e-3);
  }
}

TEST(FrameScanner, ALeaningWallIsMetAtTheCamerasHeight) {
  const Frame frame = NoisyFrame([](double rise) { return 3.0 / (1.0 - 0.2 * rise); }, 2);
  EXPECT_NEAR(MeanForwardM(MatchedScan(frame, kAgreeSigmas)), 3.0, 1e-3);
}

// A ball's edge or a roof's: from near by its nearest part alone would lie within the noise.
TEST(FrameScanner, ASteepSurfaceIsMetAtTheCamerasHeightFromAnyDistance) {
  for (const double lean : {-0.7, -0.35, 0.35, 0.7}) {
    for (const double wall_m : {0.8, 1.5, 2.5, 4.0}) {
      const Frame frame = NoisyFrame([&](double rise) { return wall_m / (1.0 - lean * rise); }, 3);
      EXPECT_NEAR(MeanForwardM(MatchedScan(frame, kAgreeSigmas)), wall_m, 3e-3) << lean;
    }
  }
}

TEST(FrameScanner, OfAFlatWallNearlyAllBearingsTakeTheWholeSlice) {
  const Frame frame = NoisyFrame([](double) { return 3.0; }, 3);
  const Scan some = MatchedScan(frame, kAgreeSigmas), all = MatchedScan(frame, 0.0);
  int inner = 0;
  for (std::size_t k = 0; k < all.beams.size(); ++k) {
    inner += some.beams[k].range_m != all.beams[k].range_m ? 1 : 0;
  }
  EXPECT_GT(inner, 0);
  EXPECT_LT(inner, 0.05 * static_cast<double>(all.beams.size()));
}

TEST(FrameScanner, WithoutASliceTheObstaclesAreMatched) {
  ScanOptions options;
  options.slice_half_height_m = 0.0;
  const FrameScans scans = FrameScanner(PinholeCamera{}, options).ScansOf(WallFrame());
  EXPECT_EQ(scans.obstacles, scans.matched);
}

Frame FrameIn(const AnalyticRoom& room, const PinholeCamera& camera, const Pose3& pose) {
  Frame frame;
  frame.slam_from_camera = pose;
  frame.depth = std::make_shared<DepthImage>(room.Render(camera, pose));
  return frame;
}

// How many hits of a scan from the origin lie on the room's walls, and how many do not.
std::pair<int, int> HitsOnWallsAndOff(const Scan& scan) {
  const AnalyticRoom room;
  int on = 0, off = 0;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    const Eigen::Vector2d point =
        beam.range_m * Eigen::Vector2d(std::cos(beam.bearing_rad), std::sin(beam.bearing_rad));
    const bool is_on = std::abs(std::abs(point.x()) - room.walls.high.x()) < 0.02 ||
                       std::abs(std::abs(point.y()) - room.walls.high.y()) < 0.02;
    ++(is_on ? on : off);
  }
  return {on, off};
}

// The image reaches 26.6 degrees above its axis. From 30 degrees down it ends 3.4 below the
// horizon, where the slice around the camera is in view up to 0.1 m / tan 3.4 = 1.7 m: no wall
// stands as near. The table's near edge leaves the image when the camera comes near: where it ends
// then moves along.
TEST(FrameScanner, BelowTheHorizonASliceAboveTheFloorIsMatched) {
  const PinholeCamera camera;
  AnalyticRoom room;
  room.boxes = {{{0.8, -0.5, 0.70}, {1.6, 0.5, 0.74}}};
  ScanOptions options;
  options.floor = FloorSource::kPose;
  FrameScanner scanner(camera, options);
  for (const double roll_deg : {0.0, 90.0, 180.0}) {
    for (const double down_deg : {20.0, 30.0, 40.0}) {
      SCOPED_TRACE(testing::Message() << down_deg << " down, rolled " << roll_deg);
      const Pose3 pose =
          TiltedCamera({}, kCameraHeightM, RadFromDeg(down_deg), RadFromDeg(roll_deg));
      const FrameScans scans = scanner.ScansOf(FrameIn(room, camera, pose));
      const auto [obstacles_on, obstacles_off] = HitsOnWallsAndOff(*scans.obstacles);
      EXPECT_GT(obstacles_off, 100);
      const auto [matched_on, matched_off] = HitsOnWallsAndOff(*scans.matched);
      EXPECT_GT(matched_on, 150);
      EXPECT_EQ(matched_off, 0);
    }
  }
}

// Without a floor nobody knows where a slice above it would be.
TEST(FrameScanner, BelowTheHorizonObstaclesAreMatchedBeforeTheFloorIsSeen) {
  for (const double down_deg : {20.0, 40.0}) {
    Frame frame = WallFrame();
    frame.slam_from_camera = TiltedCamera({}, 0.0, RadFromDeg(down_deg), 0.0);
    const FrameScans scans = FrameScanner(PinholeCamera{}, ScanOptions{}).ScansOf(frame);
    EXPECT_EQ(scans.matched == scans.obstacles, down_deg == 40.0);
  }
}

// As on a vacuum cleaner: the floor is nearer below the camera than the slice reaches.
TEST(FrameScanner, TheFloorBelowALowCameraIsNotMatched) {
  const PinholeCamera camera;
  const Frame frame = FrameIn({}, camera, CameraOf(Pose2{}, 0.08));
  Frame unknown = frame;
  unknown.slam_from_camera->translation.z() = 0.0;
  for (const Frame& given : {frame, unknown}) {
    const FrameScans scans = FrameScanner(camera, ScanOptions{}).ScansOf(given);
    ASSERT_TRUE(scans.stand);
    EXPECT_NEAR(scans.stand->height_m, 0.08, 0.002);
    const auto [on, off] = HitsOnWallsAndOff(*scans.matched);
    EXPECT_GT(on, 600);
    EXPECT_EQ(off, 0);
  }
}

TEST(FrameScanner, AReadyScanIsBoth) {
  Frame frame;
  const auto scan = std::make_shared<Scan>();
  scan->max_range_m = 6.0;
  scan->beams = {{-0.1F, 2.0F, 0.0F, 2.0F, true}, {0.1F, 3.0F, 0.0F, 3.0F, true}};
  const Scan given = *scan;
  frame.scan = scan;
  const FrameScans scans = FrameScanner({}, ScanOptions{}).ScansOf(frame);
  EXPECT_EQ(scans.obstacles, scans.matched);
  EXPECT_EQ(*scans.matched, given);
  scan->beams.clear();  // the caller's own, to fill again
  EXPECT_EQ(*scans.matched, given);
}

Scan SoundPartOf(const Scan& scan) {
  Frame frame;
  frame.scan = std::make_shared<const Scan>(scan);
  return *FrameScanner({}, ScanOptions{}).ScansOf(frame).matched;
}

// As drivers bring them: from left to right, from any bearing on, twice round.
TEST(FrameScanner, BeamsOfAReadyScanAreBroughtIntoTheirOrder) {
  Scan scan{.beams = {{3.0F, 2.0F, 0.0F, 2.0F, true},
                      {-1.0F, 3.0F, 0.0F, 3.0F, true},
                      {7.0F, 4.0F, 0.0F, 4.0F, false}},
            .max_range_m = 6.0};
  const Scan sorted = SoundPartOf(scan);
  std::swap(scan.beams[0], scan.beams[1]);
  EXPECT_EQ(sorted, scan);
}

TEST(FrameScanner, HitsThatAreNoneAndBearingsOfNoCircleSayNothing) {
  const Beam sound{0.0F, 2.0F, 0.0F, 2.0F, true};
  for (const Beam& stray : std::vector<Beam>{{0.1F, 0.0F, 0.0F, 0.0F, true},
                                             {0.1F, -2.0F, 0.0F, 0.0F, true},
                                             {0.1F, 6.5F, 0.0F, 6.5F, true},
                                             {1e9F, 2.0F, 0.0F, 2.0F, true}}) {
    const Scan scan{.beams = {sound, stray}, .max_range_m = 6.0};
    EXPECT_EQ(SoundPartOf(scan).beams, std::vector<Beam>{sound});
  }
}

TEST(FrameScanner, NothingIsClearBeyondTheScansReach) {
  const Scan scan{.beams = {{0.0F, 0.0F, 0.0F, 80.0F, false}}, .max_range_m = 6.0};
  EXPECT_EQ(SoundPartOf(scan).beams[0].clear_to_m, 6.0F);
  // Without a reach nothing beyond 250 m is a distance: drivers' numbers for "nothing came back".
  const Beam far{0.2F, 0.0F, 0.0F, 250.0F, false};
  const Scan unknown{.beams = {{0.0F, 0.0F, 0.0F, 65535.0F, false},
                               {0.1F, 260.0F, 0.0F, 260.0F, true},
                               far,
                               {0.3F, 5.0F, 0.0F, 1e9F, true}}};
  const Beam hit{0.3F, 5.0F, 0.0F, 250.0F, true};
  EXPECT_EQ(SoundPartOf(unknown).beams, (std::vector<Beam>{far, hit}));
}

TEST(FrameScanner, WithoutImageOrPoseThereIsNoScan) {
  Frame frame = WallFrame();
  frame.slam_from_camera.reset();
  EXPECT_EQ(FrameScanner(PinholeCamera{}, ScanOptions{}).ScansOf(frame).matched, nullptr);
  EXPECT_EQ(FrameScanner(PinholeCamera{}, ScanOptions{}).ScansOf(Frame{}).obstacles, nullptr);
}

// As drivers of depth cameras mark them (ROS, 32FC1).
TEST(FrameScanner, PixelsThatAreNotNumbersAreInvalidOnes) {
  const Frame whole = WallFrame();
  std::vector<FrameScans> scans;
  for (const float missing : {kInvalidDepth, std::numeric_limits<float>::quiet_NaN(),
                              -std::numeric_limits<float>::quiet_NaN()}) {
    auto image = std::make_shared<DepthImage>(*whole.depth);
    for (std::size_t i = 0; i < image->z_m.size(); i += 3) image->z_m[i] = missing;
    std::fill_n(image->Row(200), 20 * image->width_px, missing);
    Frame frame = whole;
    frame.depth = image;
    scans.push_back(FrameScanner(PinholeCamera{}, ScanOptions{}).ScansOf(frame));
    EXPECT_EQ(*scans.back().obstacles, *scans.front().obstacles);
    EXPECT_EQ(*scans.back().matched, *scans.front().matched);
  }
}

TEST(FrameScanner, BeamsOfAReadyScanThatAreNotFiniteSayNothing) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  auto scan = std::make_shared<Scan>();
  scan->max_range_m = 6.0;
  scan->beams = {{0.0F, 2.0F, 0.0F, 2.0F, true},      {0.1F, -infinity, 0.0F, 2.0F, true},
                 {0.2F, infinity, 0.0F, 2.0F, true},  {0.3F, nan, 0.0F, 2.0F, true},
                 {0.4F, 2.0F, 0.0F, infinity, true},  {nan, 2.0F, 0.0F, 2.0F, true},
                 {0.5F, 2.0F, -infinity, 2.0F, true}, {0.6F, nan, 0.0F, 5.0F, false}};
  Frame frame;
  frame.scan = scan;
  const FrameScans scans = FrameScanner(std::nullopt, ScanOptions{}).ScansOf(frame);
  EXPECT_EQ(scans.matched, scans.obstacles);
  ASSERT_EQ(scans.matched->beams.size(), 2U);
  EXPECT_EQ(scans.matched->beams[0], scan->beams.front());
  EXPECT_EQ(scans.matched->beams[1].clear_to_m, 5.0F);
  EXPECT_TRUE(CanBeKept(scans.matched->beams[1]));
  EXPECT_EQ(scans.matched->max_range_m, 6.0);
}

// SLAM's z is corrected by a third of a metre, untold, while the camera goes on.
TEST(FrameScanner, ACorrectionThatSlamDoesNotTellLeavesTheFloorWhereItIs) {
  const PinholeCamera camera{160, 120, 120.3, 120.0, 79.5, 59.5, {}};
  FrameScanner scanner(camera, ScanOptions{});
  const AnalyticRoom room;
  for (int i = 0; i < 30; ++i) {
    const Pose3 truth = TiltedCamera({-1.0 + 0.01 * i, 0.0, 0.0}, kCameraHeightM, 0.3, 0.0);
    Frame frame;
    frame.index = i;
    frame.stamp_s = i / 30.0;
    frame.depth = std::make_shared<const DepthImage>(room.Render(camera, truth));
    frame.slam_from_camera = truth;
    if (i >= 15) frame.slam_from_camera->translation.z() += 0.35;
    const FrameScans scans = scanner.ScansOf(frame);
    ASSERT_TRUE(scans.stand);
    EXPECT_NEAR(scans.stand->height_m, kCameraHeightM, 0.02) << i;
  }
}

}  // namespace
}  // namespace depthgrid
