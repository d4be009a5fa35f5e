#include "mapper/scan/depth_to_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "tests/mapper/analytic_room.h"
#include "tests/refusal.h"

namespace depthgrid {
namespace {

AnalyticRoom RoomWithPillars() {
  AnalyticRoom room;
  room.cylinders = {{{1.5, 0.4}, 0.2, 0.0, 2.5}, {{2.0, -0.6}, 0.05, 0.0, 2.5}};
  return room;
}

struct RangeErrors {
  int beams = 0;
  int hits = 0;
  double sum_squares = 0.0;
  double worst_m = 0.0;
  double Rms() const { return std::sqrt(sum_squares / std::max(hits, 1)); }
};

// Against the level scan in closed form, for beams below 60 degrees of incidence and away from
// silhouettes, where a beam may fall on either side of an edge.
void Compare(const Scan& scan, const AnalyticRoom& room, const Pose2& world_from_base,
             RangeErrors& errors) {
  constexpr double kPixelRad = 1.0 / 480.0;
  for (const Beam& beam : scan.beams) {
    const auto truth = room.Level(world_from_base, beam.bearing_rad, kCameraHeightM);
    const auto left = room.Level(world_from_base, beam.bearing_rad + kPixelRad, kCameraHeightM);
    const auto right = room.Level(world_from_base, beam.bearing_rad - kPixelRad, kCameraHeightM);
    const bool silhouette = std::abs(left.range_m - right.range_m) > 0.05 * truth.range_m;
    if (truth.incidence_rad > RadFromDeg(60.0) || silhouette) continue;
    ++errors.beams;
    if (!beam.hit) continue;
    ++errors.hits;
    const double error_m = beam.range_m - truth.range_m;
    errors.sum_squares += error_m * error_m;
    errors.worst_m = std::max(errors.worst_m, std::abs(error_m));
  }
}

TEST(DepthToScan, AgreesWithTheLevelScanAtAnyTiltAndRoll) {
  const AnalyticRoom room = RoomWithPillars();
  const PinholeCamera camera;
  const DepthToScan converter(camera, {});
  int cases = 0;
  for (const double pitch_deg : {-15.0, -7.0, 0.0, 8.0, 15.0}) {
    for (const double roll_deg : {-15.0, -3.0, 0.0, 10.0}) {
      const Pose2 base{-1.5, 0.3, RadFromDeg(10.0 * cases)};
      const Pose3 pose =
          TiltedCamera(base, kCameraHeightM, RadFromDeg(pitch_deg), RadFromDeg(roll_deg));
      RangeErrors errors;
      Compare(converter.Convert(room.Render(camera, pose), pose), room, BaseOf(pose), errors);
      EXPECT_LT(errors.Rms(), 0.0005) << pitch_deg << " " << roll_deg;
      EXPECT_LT(errors.worst_m, 0.003) << pitch_deg << " " << roll_deg;
      EXPECT_GT(errors.beams, 100);
      // Looking down, the corners of the field of view see only floor.
      EXPECT_GE(errors.hits, errors.beams * 0.85) << pitch_deg << " " << roll_deg;
      ++cases;
    }
  }
}

TEST(DepthToScan, NoBeamIsEmptyWhenLevel) {
  AnalyticRoom room;
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({0, 0, 0.3}, kCameraHeightM);
  const Scan scan = DepthToScan(camera, {}).Convert(room.Render(camera, pose), pose);
  ASSERT_EQ(scan.beams.size(), 640U);
  for (const Beam& beam : scan.beams) EXPECT_TRUE(beam.hit);
  EXPECT_NEAR(DegFromRad(scan.beams.back().bearing_rad - scan.beams.front().bearing_rad),
              67.25 * 639.0 / 640.0, 0.01);
}

// Four beams a pixel: those in the outer half of an outer pixel have no depth of their own, and
// with that of its centre the wall would bend there by 2 cm.
TEST(DepthToScan, AWallThatRecedesDoesNotBendAtTheImagesEdge) {
  const AnalyticRoom room;
  const PinholeCamera camera{160, 120, 120.0, 120.0, 79.5, 59.5, {}};
  for (const double side : {-1.0, 1.0}) {
    const Pose2 base{0.0, side * 1.5, 0.0};
    const Pose3 pose = CameraOf(base, kCameraHeightM);
    const Scan scan = DepthToScan(camera, {}).Convert(room.Render(camera, pose), pose);
    int hits = 0;
    for (std::size_t i = 0; i < 40; ++i) {
      const Beam& beam = side < 0.0 ? scan.beams[i] : scan.beams[scan.beams.size() - 1 - i];
      if (!beam.hit) continue;
      ++hits;
      const double truth_m = room.Level(base, beam.bearing_rad, kCameraHeightM).range_m;
      EXPECT_NEAR(beam.range_m, truth_m, 0.002) << i;
    }
    EXPECT_GE(hits, 36);
  }
}

// Eight bearings to a pixel; neighbouring pixels of the side wall differ by up to a tenth in depth.
TEST(DepthToScan, AWallThatRecedesHasNoStepsInImagesOfFewColumns) {
  const AnalyticRoom room;
  const PinholeCamera camera{80, 60, 58.0, 58.0, 39.5, 29.5, {}};
  const Pose2 base{-1.0, 1.5, 0.0};
  const Pose3 pose = TiltedCamera(base, kCameraHeightM, 0.1, 0.05);
  const Scan scan = DepthToScan(camera, {}).Convert(room.Render(camera, pose), pose);
  const auto recedes = [&](double bearing_rad) {
    const auto truth = room.Level(BaseOf(pose), bearing_rad, kCameraHeightM);
    return truth.incidence_rad > RadFromDeg(65.0);
  };
  constexpr double kPixelRad = 1.0 / 58.0;
  int receding = 0;
  for (const Beam& beam : scan.beams) {
    const double bearing_rad = beam.bearing_rad;
    // Not across the room's corner.
    if (!recedes(bearing_rad - kPixelRad) || !recedes(bearing_rad + kPixelRad)) continue;
    if (!beam.hit) continue;
    ++receding;
    const double truth_m = room.Level(BaseOf(pose), bearing_rad, kCameraHeightM).range_m;
    EXPECT_NEAR(beam.range_m, truth_m, 0.003 * truth_m) << bearing_rad;
  }
  EXPECT_GT(receding, 50);
}

TEST(DepthToScan, PortraitAndUpsideDownImagesGiveTheSameScan) {
  const AnalyticRoom room = RoomWithPillars();
  PinholeCamera camera;
  const DepthToScan converter(camera, {});
  for (const double roll_deg : {90.0, -90.0, 180.0, 80.0, -130.0}) {
    const Pose3 pose =
        TiltedCamera({-1.5, 0.3, 0.1}, kCameraHeightM, RadFromDeg(5.0), RadFromDeg(roll_deg));
    const Scan scan = converter.Convert(room.Render(camera, pose), pose);
    RangeErrors errors;
    Compare(scan, room, BaseOf(pose), errors);
    EXPECT_LT(errors.Rms(), 0.001) << roll_deg;
    EXPECT_GE(errors.hits, errors.beams * 0.9) << roll_deg;
    EXPECT_GT(errors.hits, 300) << roll_deg;
  }
}

TEST(DepthToScan, ThinThingsAreFoundAndStrayPixelsAreNot) {
  AnalyticRoom room = RoomWithWallAt(4.0);
  room.boxes.push_back({{2.0, -0.5, 0.70}, {2.02, 0.5, 0.73}});  // a 3 cm board
  room.cylinders.push_back({{2.5, 0.9}, 0.01, 0.0, 1.5});        // a 2 cm pole
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({}, kCameraHeightM);
  DepthImage image = room.Render(camera, pose);
  image.Row(240)[500] = 1.0F;
  image.Row(200)[520] = 0.7F;
  const Scan scan = DepthToScan(camera, {}).Convert(image, pose);
  int on_board = 0, board_beams = 0, pole = 0;
  for (const Beam& beam : scan.beams) {
    ASSERT_TRUE(beam.hit);
    const Eigen::Vector2d end = EndPoint(beam);
    EXPECT_GT(end.x(), 1.99);
    if (std::abs(std::tan(beam.bearing_rad)) < 0.24) {
      ++board_beams;
      on_board += std::abs(end.x() - 2.0) < 0.003 ? 1 : 0;
    }
    pole += (end - Eigen::Vector2d(2.5, 0.9)).norm() < 0.02 ? 1 : 0;
  }
  EXPECT_GT(board_beams, 200);
  EXPECT_EQ(on_board, board_beams);
  EXPECT_GE(pole, 3);
}

// The camera sees over a table nearer than 1.4 m, and hits the wall behind it.
TEST(DepthToScan, AFarHitDoesNotErasetheNearTable) {
  AnalyticRoom room = RoomWithWallAt(4.0);
  room.boxes.push_back({{0.4, -0.8, 0.0}, {1.2, 0.8, 0.45}});
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({}, kCameraHeightM);
  const Scan scan = DepthToScan(camera, {}).Convert(room.Render(camera, pose), pose);
  // The lowest pixel's ray falls 239.5 / 480 a metre: it reaches the band's edge at 2.10 m ahead.
  const double from_m = (kCameraHeightM - 0.1) / (239.5 / 480.0);
  int seen_over = 0;
  for (const Beam& beam : scan.beams) {
    ASSERT_TRUE(beam.hit);
    EXPECT_NEAR(EndPoint(beam).x(), 4.0, 1e-3);
    EXPECT_NEAR(beam.clear_from_m * std::cos(beam.bearing_rad), from_m, 1e-3);
    EXPECT_EQ(beam.clear_to_m, beam.range_m);
    ++seen_over;
  }
  EXPECT_EQ(seen_over, 640);
}

TEST(DepthToScan, TooNearTooFarAndInvalidAreThreeThings) {
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({}, kCameraHeightM);
  ScanOptions options;
  options.max_range_m = 3.0;
  const DepthToScan converter(camera, options);
  const DepthImage far_wall = RoomWithWallAt(5.0).Render(camera, pose);
  const auto middle = [&](const DepthImage& image) {
    return converter.Convert(image, pose).beams[320];
  };
  // Too far: no hit, free up to the limit.
  EXPECT_FALSE(middle(far_wall).hit);
  EXPECT_EQ(middle(far_wall).clear_to_m, 3.0F);
  EXPECT_GT(middle(far_wall).clear_from_m, 2.0F);
  // Invalid, and too near: no hit, nothing free.
  for (const float value : {kInvalidDepth, 0.2F}) {
    DepthImage image = far_wall;
    for (int v = 100; v < 400; ++v) {
      for (int u = 300; u < 340; ++u) image.Row(v)[u] = value;
    }
    EXPECT_FALSE(middle(image).hit);
    EXPECT_GE(middle(image).clear_from_m, middle(image).clear_to_m) << value;
  }
  // A third of the pixels missing at random hides nothing.
  DepthImage image = far_wall;
  RandomStream random(4, RandomStage::kTest);
  for (float& z_m : image.z_m) z_m = random.Uniform() < 0.33 ? kInvalidDepth : z_m;
  EXPECT_NEAR(middle(image).clear_to_m, 3.0F, 1e-3);
  EXPECT_NEAR(middle(image).clear_from_m, middle(far_wall).clear_from_m, 0.03);
}

TEST(DepthToScan, FloorAndCeilingOnlyClear) {
  // Nothing but a floor: a room whose walls are far beyond the range.
  AnalyticRoom hall;
  hall.walls = {{-50.0, -50.0, 0.0}, {50.0, 50.0, 2.5}};
  const PinholeCamera camera;
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(40.0), 0.0);
  const Scan scan = DepthToScan(camera, {}).Convert(hall.Render(camera, pose), pose);
  const Beam& middle = scan.beams[320];
  EXPECT_FALSE(middle.hit);
  // The highest ray falls with 40 - 26.5 degrees and reaches 0.1 m at 4.37 m.
  const double top_rad = RadFromDeg(40.0) - std::atan(239.5 / 480.0);
  EXPECT_NEAR(middle.clear_to_m, 1.05 / std::tan(top_rad), 0.01);
}

// Two rows of a wall are too few for a hit, and yet nothing behind it was seen.
TEST(DepthToScan, WhereTooLittleOfAWallIsSeenNothingBehindItIsFree) {
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({}, kCameraHeightM);
  const auto two_rows_at = [&](double wall_m) {
    const DepthImage whole = RoomWithWallAt(wall_m).Render(camera, pose);
    DepthImage image(camera.width_px, camera.height_px);
    for (const int v : {400, 410}) std::copy_n(whole.Row(v), image.width_px, image.Row(v));
    return image;
  };
  // The two rays are at the band's lower edge at 3.14 m and at 2.96 m.
  const DepthToScan converter(camera, {});
  const Beam behind = converter.Convert(two_rows_at(5.0), pose).beams[320];
  EXPECT_FALSE(behind.hit);
  EXPECT_NEAR(behind.clear_from_m, 1.05 / (170.5 / 480.0), 1e-3);
  EXPECT_NEAR(behind.clear_to_m, 1.05 / (160.5 / 480.0), 1e-3);
  const Beam between = converter.Convert(two_rows_at(3.0), pose).beams[320];
  EXPECT_EQ(between.clear_from_m, behind.clear_from_m);
  EXPECT_NEAR(between.clear_to_m, 3.0, 2e-3);
  const Beam before = converter.Convert(two_rows_at(2.0), pose).beams[320];
  EXPECT_FALSE(before.hit);
  EXPECT_EQ(before.clear_from_m, before.clear_to_m);
}

// The row of the optical axis alone, and in most bearings it sees a thing of one row.
TEST(DepthToScan, RowModesClearNoFartherThanTheySaw) {
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({}, kCameraHeightM);
  DepthImage image = RoomWithWallAt(7.0).Render(camera, pose);
  for (int v = 0; v < image.height_px; ++v) {
    if (v != 240) std::fill_n(image.Row(v), image.width_px, kInvalidDepth);
  }
  ScanOptions options;
  options.mode = ScanMode::kRowBand;
  const auto middle = [&] { return DepthToScan(camera, options).Convert(image, pose).beams[320]; };
  EXPECT_FALSE(middle().hit);
  EXPECT_NEAR(middle().clear_to_m, 6.0, 1e-3);
  std::fill_n(image.Row(240), image.width_px, 2.0F);
  EXPECT_FALSE(middle().hit);
  EXPECT_NEAR(middle().clear_to_m, 2.0, 2e-3);
}

TEST(DepthToScan, RowModesReadLikeALaser) {
  AnalyticRoom room = RoomWithWallAt(4.0);
  room.boxes.push_back({{2.0, -0.5, 0.0}, {2.5, 0.5, 0.9}});  // below the optical axis
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({}, kCameraHeightM);
  const DepthImage image = room.Render(camera, pose);
  ScanOptions options;
  options.mode = ScanMode::kCentreRow;
  const Scan row = DepthToScan(camera, options).Convert(image, pose);
  for (const Beam& beam : row.beams) {
    ASSERT_TRUE(beam.hit);
    EXPECT_NEAR(EndPoint(beam).x(), 4.0, 1e-3);
    EXPECT_EQ(beam.clear_from_m, 0.0F);
    EXPECT_EQ(beam.clear_to_m, beam.range_m);
  }
  options.mode = ScanMode::kRowBand;
  options.band_rows = 150;  // 75 rows down: 0.156 a metre, 0.79 m of height at 2.3 m
  EXPECT_NEAR(DepthToScan(camera, options).Convert(image, pose).beams[320].range_m, 2.0, 0.01);
  options.band_rows = 20;
  EXPECT_NEAR(DepthToScan(camera, options).Convert(image, pose).beams[320].range_m, 4.0, 0.01);
}

TEST(DepthToScan, HitPixelsLeadBackToTheHits) {
  const AnalyticRoom room = RoomWithPillars();
  const PinholeCamera camera;
  const DepthToScan converter(camera, {});
  int hits = 0;
  for (const double roll_deg : {5.0, 90.0}) {
    const Pose3 pose = TiltedCamera({-1.5, 0.3, 0.1}, kCameraHeightM, 0.2, RadFromDeg(roll_deg));
    const DepthImage image = room.Render(camera, pose);
    const Scan scan = converter.Convert(image, pose);
    const auto pixels = converter.HitPixels(image, StandOf(pose, 0.0), scan);
    ASSERT_EQ(pixels.size(), scan.beams.size());
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      if (!scan.beams[k].hit) {
        EXPECT_EQ(pixels[k].x(), -1.0);
        continue;
      }
      const Eigen::Vector3d ray =
          LevelFromCamera(pose) * Unproject(camera, pixels[k].x(), pixels[k].y(), 1.0);
      EXPECT_NEAR(std::atan2(ray.y(), ray.x()), scan.beams[k].bearing_rad, 1e-4);
      ++hits;
    }
  }
  EXPECT_GT(hits, 900);
}

TEST(DepthToScan, ContradictingOptionsAreRefused) {
  const auto error_of = [](const ScanOptions& options) {
    return RefusalOf([&] { DepthToScan converter(PinholeCamera{}, options); });
  };
  ScanOptions band;
  band.band_low_m = 2.0;
  EXPECT_EQ(error_of(band), "mapper.scan.band_low_m: is 2, must be below band_high_m, 1.8");
  ScanOptions range;
  range.min_range_m = 7.0;
  EXPECT_EQ(error_of(range), "mapper.scan.min_range_m: is 7, must be below max_range_m, 6");
}

// All rays of a long lens that looks straight down are too steep for a bearing.
TEST(DepthToScan, SeesNothingStraightBelow) {
  const PinholeCamera camera{
      .width_px = 64, .height_px = 48, .fx_px = 5000, .fy_px = 5000, .cx_px = 31.5, .cy_px = 23.5};
  const Pose3 pose = TiltedCamera({}, kCameraHeightM, RadFromDeg(90.0), 0.0);
  DepthImage depth(camera.width_px, camera.height_px);
  std::fill(depth.z_m.begin(), depth.z_m.end(), 1.0F);
  const Scan scan = DepthToScan(camera, {}).Convert(depth, pose);
  EXPECT_FALSE(scan.beams.empty());
  for (const Beam& beam : scan.beams) {
    EXPECT_FALSE(beam.hit);
    EXPECT_LE(beam.clear_to_m, beam.clear_from_m);
  }
}

// Nothing checks a camera's centre here. What its scans say is nothing to rely on, but they read
// within the image: single precision no longer tells such a camera's rows apart.
TEST(DepthToScan, ReadsWithinTheImageWhateverTheCamera) {
  RandomStream random(7, RandomStage::kTest);
  PinholeCamera camera{.width_px = 640, .height_px = 480};
  DepthImage depth(camera.width_px, camera.height_px);
  for (float& z_m : depth.z_m) z_m = static_cast<float>(0.5 + 4.0 * random.Uniform());
  ScanMemory memory;
  for (int i = 0; i < 1000; ++i) {
    const auto far = [&] {
      return (random.Uniform() - 0.5) * std::pow(10.0, 16.0 * random.Uniform());
    };
    camera.fx_px = camera.fy_px = std::pow(10.0, 6.0 * random.Uniform() - 2.0);
    camera.cx_px = far();
    camera.cy_px = far();
    const Pose3 pose =
        TiltedCamera({}, kCameraHeightM, 0.6 * random.Normal(), 0.6 * random.Normal());
    const CameraStand stand = StandOf(pose, 0.0);
    const ScanPair scans = DepthToScan(camera, {}).ConvertBoth(depth, stand, {-0.1, 0.1}, memory);
    ASSERT_FALSE(scans.obstacles.beams.empty());
  }
}

}  // namespace
}  // namespace depthgrid
