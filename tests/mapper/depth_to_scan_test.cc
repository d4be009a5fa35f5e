#include "mapper/scan/depth_to_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/error.h"
#include "mapper/core/rng.h"
#include "mapper/scan/bearing_returns.h"
#include "mapper/scan/clear_interval.h"
#include "mapper/scan/floor_height.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

constexpr double kHeightM = 1.15;  // ICL-NUIM's living room

AnalyticRoom RoomWithPillars() {
  AnalyticRoom room;
  room.cylinders = {{{1.5, 0.4}, 0.2, 0.0, 2.5}, {{2.0, -0.6}, 0.05, 0.0, 2.5}};
  return room;
}

struct Errors {
  int beams = 0;
  int hits = 0;
  double sum_squares = 0.0;
  double worst_m = 0.0;
  double Rms() const { return std::sqrt(sum_squares / std::max(hits, 1)); }
};

// Against the level scan in closed form, for beams below 60 degrees of incidence and away from
// silhouettes, where a beam may fall on either side of an edge.
void Compare(const Scan& scan, const AnalyticRoom& room, const Pose2& world_from_base,
             Errors& errors) {
  constexpr double kPixelRad = 1.0 / 480.0;
  for (const Beam& beam : scan.beams) {
    const auto truth = room.Level(world_from_base, beam.bearing_rad, kHeightM);
    const auto left = room.Level(world_from_base, beam.bearing_rad + kPixelRad, kHeightM);
    const auto right = room.Level(world_from_base, beam.bearing_rad - kPixelRad, kHeightM);
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
      const Pose3 pose = TiltedCamera(base, kHeightM, RadFromDeg(pitch_deg), RadFromDeg(roll_deg));
      Errors errors;
      Compare(converter.Convert(room.Render(camera, pose), pose), room, BaseOf(pose), errors);
      EXPECT_LT(errors.Rms(), 0.0005) << pitch_deg << " " << roll_deg;
      EXPECT_LT(errors.worst_m, 0.003) << pitch_deg << " " << roll_deg;
      EXPECT_GT(errors.beams, 100);
      // Looking down, the corners of the field of view see only floor.
      EXPECT_GE(errors.hits, errors.beams * 0.85) << pitch_deg << " " << roll_deg;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 20);
}

TEST(DepthToScan, NoBeamIsEmptyWhenLevel) {
  AnalyticRoom room;
  const PinholeCamera camera;
  const Pose3 pose = CameraOf({0, 0, 0.3}, kHeightM);
  const Scan scan = DepthToScan(camera, {}).Convert(room.Render(camera, pose), pose);
  ASSERT_EQ(scan.beams.size(), 640U);
  for (const Beam& beam : scan.beams) EXPECT_TRUE(beam.hit);
  EXPECT_NEAR(DegFromRad(scan.beams.back().bearing_rad - scan.beams.front().bearing_rad),
              67.25 * 639.0 / 640.0, 0.01);
}

}  // namespace
}  // namespace depthgrid
