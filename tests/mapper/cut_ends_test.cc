// Walls that recede beyond a depth camera's reach, which cuts what noise made longer.
#include "mapper/scan/cut_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "mapper/core/rng.h"
#include "mapper/scan/frame_scans.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

constexpr double kReachM = 4.5;
constexpr double kSigmaM = 0.009;
constexpr double kWallM = 3.0;                  // to the left
constexpr double kHeadingRad = RadFromDeg(35);  // towards the wall, which is out of reach ahead

AnalyticRoom LongRoom() {
  AnalyticRoom room;
  room.walls = {{-30.0, -30.0, 0.0}, {30.0, kWallM, 2.5}};
  return room;
}

DepthImage Seen(const AnalyticRoom& room, const PinholeCamera& camera, const Pose3& pose,
                RandomStream& random, double sigma_m) {
  DepthImage image = room.Render(camera, pose);
  for (float& z_m : image.z_m) {
    z_m += static_cast<float>(sigma_m * random.Normal());
    if (z_m > static_cast<float>(kReachM)) z_m = kInvalidDepth;
  }
  return image;
}

Scan SliceOf(const DepthImage& image, const PinholeCamera& camera, const Pose3& pose, bool drop,
             double max_range_m = 6.0) {
  ScanOptions options;
  options.drop_cut_ends = drop;
  options.max_range_m = max_range_m;
  FrameScanner scanner(camera, options);
  Frame frame;
  frame.depth = std::make_shared<const DepthImage>(image);
  frame.slam_from_camera = pose;
  return *scanner.ScansOf(frame).matched;
}

// Two walls across the view, at these depths.
DepthImage TwoWalls(float left_m, float right_m) {
  DepthImage image;
  image.width_px = 640;
  image.height_px = 480;
  image.z_m.assign(640 * 480, right_m);
  for (int v = 0; v < image.height_px; ++v) std::fill_n(image.Row(v), 320, left_m);
  return image;
}

// The end of what is nearer than that is no end of the camera's reach.
TEST(NoiseWindow, TellsHowFarACameraSees) {
  EXPECT_EQ(NoiseWindow(TwoWalls(2.2F, 4.3F)).farthest_m(), 4.0);
  EXPECT_EQ(NoiseWindow(TwoWalls(9.2F, 14.3F)).farthest_m(), 14.0);
  EXPECT_EQ(NoiseWindow(TwoWalls(2.2F, 65.535F)).farthest_m(), 2.0);
  EXPECT_EQ(NoiseWindow(TwoWalls(0.0F, std::numeric_limits<float>::infinity())).farthest_m(), 0.0);
}

// How far before the wall the last four hits towards the reach lie in the mean.
double BendM(const Scan& scan) {
  double sum_m = 0.0;
  int count = 0;
  for (const Beam& beam : scan.beams) {  // from the right, where the wall is farthest
    if (!beam.hit || count == 4) continue;
    sum_m += kWallM - beam.range_m * std::sin(beam.bearing_rad + kHeadingRad);
    ++count;
  }
  EXPECT_EQ(count, 4);
  return sum_m / count;
}

int Hits(const Scan& scan) {
  return static_cast<int>(std::count_if(scan.beams.begin(), scan.beams.end(),
                                        [](const Beam& beam) { return beam.hit; }));
}

TEST(CutEnds, AWallThatRecedesBeyondTheReachStaysStraight) {
  const PinholeCamera camera;
  const Pose3 pose = TiltedCamera({0.0, 0.0, kHeadingRad}, kCameraHeightM, 0.0, 0.0);
  RandomStream random(1, RandomStage::kTest);
  double kept_m = 0.0, dropped_m = 0.0;
  constexpr int kImages = 10;
  for (int i = 0; i < kImages; ++i) {
    const DepthImage image = Seen(LongRoom(), camera, pose, random, kSigmaM);
    const Scan kept = SliceOf(image, camera, pose, false);
    const Scan dropped = SliceOf(image, camera, pose, true);
    kept_m += BendM(kept) / kImages;
    dropped_m += BendM(dropped) / kImages;
    EXPECT_GT(Hits(dropped), 0.8 * Hits(kept));
  }
  EXPECT_GT(kept_m, 0.003);
  EXPECT_NEAR(dropped_m, 0.0, 0.001);
}

TEST(CutEnds, NothingIsDroppedWhereAllIsSeen) {
  const PinholeCamera camera;
  const Pose3 pose = TiltedCamera({0.0, 0.0, kHeadingRad}, kCameraHeightM, 0.0, 0.0);
  RandomStream random(2, RandomStage::kTest);
  AnalyticRoom room;
  room.walls = {{-2.0, -2.0, 0.0}, {3.0, 2.0, 2.5}};
  const DepthImage image = Seen(room, camera, pose, random, kSigmaM);
  EXPECT_EQ(SliceOf(image, camera, pose, true), SliceOf(image, camera, pose, false));
}

// It ends there, and is as far away as anything.
TEST(CutEnds, AWallFaceOnIsKept) {
  const PinholeCamera camera;
  const Pose3 pose = TiltedCamera({0.0, 0.0, 0.0}, kCameraHeightM, 0.0, 0.0);
  RandomStream random(3, RandomStage::kTest);
  AnalyticRoom room;
  room.walls = {{-30.0, -30.0, 0.0}, {30.0, 30.0, 12.0}};
  room.boxes = {{{4.0, -1.0, 0.0}, {4.2, 1.0, 2.0}}};
  const DepthImage image = Seen(room, camera, pose, random, kSigmaM);
  const Scan scan = SliceOf(image, camera, pose, true);
  EXPECT_GT(Hits(scan), 200);
  EXPECT_EQ(scan, SliceOf(image, camera, pose, false));
}

// A stereo camera's image of a wall across the view, at a depth at which its noise is a thirtieth.
DepthImage FarWall(double wall_m, double reach_m, RandomStream& random) {
  const PinholeCamera camera;
  AnalyticRoom room;
  room.walls = {{-30.0, -30.0, 0.0}, {wall_m, 30.0, 12.0}};
  DepthImage image = room.Render(camera, TiltedCamera({}, kCameraHeightM, 0.0, 0.0));
  constexpr double kInverseSigma = 1.0 / 270.0;  // D435: Ahn 2019
  for (float& z_m : image.z_m) {
    z_m = static_cast<float>(1.0 / (1.0 / z_m + kInverseSigma * random.Normal()));
    if (z_m > static_cast<float>(reach_m)) z_m = kInvalidDepth;
  }
  return image;
}

// How far the hits lie before the wall in the mean.
double NearerM(const Scan& scan, double wall_m) {
  double sum_m = 0.0;
  for (const Beam& beam : scan.beams) {
    if (beam.hit) sum_m += wall_m - beam.range_m * std::cos(beam.bearing_rad);
  }
  return sum_m / Hits(scan);
}

// The window is narrower than its six sigmas there.
TEST(NoiseWindow, AFarWallIsNotMetAtItsNearestSamples) {
  RandomStream random(5, RandomStage::kTest);
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, 0.0, 0.0);
  for (const double wall_m : {6.0, 9.0, 12.0}) {
    const Scan scan = SliceOf(FarWall(wall_m, 100.0, random), {}, pose, true, 20.0);
    EXPECT_GT(Hits(scan), 500);
    EXPECT_NEAR(NearerM(scan, wall_m), 0.0, 0.005 * wall_m) << wall_m;
  }
}

// Of the wall at the end of what both the camera and the scan reach only what is too near is left.
TEST(CutEnds, AWallAtTheReachOfCameraAndScanIsNotMatched) {
  RandomStream random(6, RandomStage::kTest);
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, 0.0, 0.0);
  const DepthImage at_reach = FarWall(9.9, 10.0, random);
  const Scan kept = SliceOf(at_reach, {}, pose, false, 10.0);
  EXPECT_GT(Hits(kept), 100);
  EXPECT_GT(NearerM(kept, 9.9), 0.15);
  EXPECT_LT(Hits(SliceOf(at_reach, {}, pose, true, 10.0)), Hits(kept) / 20);
  // A camera that sees farther has samples on both sides of it, and a wall well before it has too.
  EXPECT_GT(Hits(SliceOf(FarWall(9.9, 100.0, random), {}, pose, true, 10.0)), 100);
  EXPECT_GT(Hits(SliceOf(FarWall(8.5, 10.0, random), {}, pose, true, 10.0)), 500);
}

// The wall is seen beyond a patch that was not measured: no reach ends it there.
TEST(CutEnds, AWallWithAHoleIsKept) {
  const PinholeCamera camera;
  const Pose3 pose = TiltedCamera({0.0, 0.0, RadFromDeg(60)}, kCameraHeightM, 0.0, 0.0);
  RandomStream random(4, RandomStage::kTest);
  AnalyticRoom room = LongRoom();
  DepthImage image = Seen(room, camera, pose, random, kSigmaM);
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 300; u < 340; ++u) image.Row(v)[u] = kInvalidDepth;
  }
  const Scan kept = SliceOf(image, camera, pose, false);
  const Scan dropped = SliceOf(image, camera, pose, true);
  const auto hits_before_hole = [](const Scan& scan) {
    return std::count_if(scan.beams.begin(), scan.beams.end(),
                         [](const Beam& beam) { return beam.hit && beam.bearing_rad > 0.0F; });
  };
  EXPECT_LT(Hits(kept), static_cast<int>(kept.beams.size()));
  EXPECT_EQ(hits_before_hole(dropped), hits_before_hole(kept));
}

}  // namespace
}  // namespace depthgrid
