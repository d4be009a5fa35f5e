#include "mapper/scan/slanting.h"

#include <gtest/gtest.h>

#include "mapper/scan/depth_to_scan.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

// 54 x 43 degrees.
PinholeCamera SmallCamera(int width_px) {
  const double f_px = 0.98 * width_px;
  const int height_px = width_px * 3 / 4;
  return {width_px, height_px, f_px, f_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1), {}};
}

struct Met {
  int beams = 0, hits = 0;
  double farthest_clear_m = 0.0;  // behind the front
  double farthest_hit_m = 0.0;
};

// Beams that go through the front of a box that stands across their way, from some places before
// it, the camera 1 m above the floor and 10 degrees down.
Met MeetFront(const AnalyticRoom& room, const PinholeCamera& camera) {
  const AnalyticRoom::Box& box = room.boxes.front();
  const DepthToScan converter(camera, {});
  Met met;
  for (const double x_m : {-0.6, -0.2, 0.1, 0.4, 0.6}) {
    const Pose3 pose = TiltedCamera({x_m, 0.0, 0.0}, 1.0, RadFromDeg(10.0), 0.0);
    const double front_m = box.low.x() - x_m;
    for (const Beam& beam : converter.Convert(room.Render(camera, pose), pose).beams) {
      const double cosine = std::cos(beam.bearing_rad);
      if (std::abs(front_m * std::tan(beam.bearing_rad)) > 0.8 * box.high.y()) continue;
      ++met.beams;
      met.farthest_clear_m = std::max(met.farthest_clear_m, beam.clear_to_m * cosine - front_m);
      if (!beam.hit) continue;
      ++met.hits;
      met.farthest_hit_m = std::max(met.farthest_hit_m, beam.range_m * cosine - front_m);
    }
  }
  return met;
}

// Of a kerb of 14 cm, 4 cm in the obstacle band, an image so small shows a row or two of the front
// and some of the top, 5 to 14 cm from each other in range. They were passed over, and all of the
// kerb was free.
TEST(Slanting, AKerbInFewRowsIsMetAtItsFront) {
  AnalyticRoom room = RoomWithWallAt(5.5);
  room.boxes.push_back({{2.8, -1.0, 0.0}, {3.6, 1.0, 0.14}});
  for (const int width_px : {160, 320, 640}) {
    const Met met = MeetFront(room, SmallCamera(width_px));
    EXPECT_GT(met.beams, 1000);
    EXPECT_EQ(met.hits, met.beams) << width_px;
    // A cell of the map, and a row where none shows the front.
    EXPECT_LT(met.farthest_clear_m, 0.12) << width_px;
    EXPECT_LT(met.farthest_hit_m, 0.12) << width_px;
  }
}

// The edge of a table, the seat of a chair: boards of 3 cm.
TEST(Slanting, BoardsAreMetNearTheirEdge) {
  for (const double height_m : {0.45, 0.72}) {
    AnalyticRoom room = RoomWithWallAt(5.5);
    room.boxes.push_back({{1.9, -0.5, height_m - 0.03}, {2.6, 0.5, height_m}});
    const Met met = MeetFront(room, SmallCamera(160));
    EXPECT_GT(met.beams, 500) << height_m;
    EXPECT_EQ(met.hits, met.beams) << height_m;
    EXPECT_LT(met.farthest_clear_m, 0.2) << height_m;
  }
}

// Along the middle line of a level camera 1 m above a floor, one sample a row.
class NearestInRows : public testing::Test {
 protected:
  float Nearest(const std::vector<float>& samples, float nearer_than_m = 5.0F) const {
    const NoiseWindow window{DepthImage(8, 8)};
    ReturnLimits limits;
    limits.max_range_m = 6.0F;
    limits.min_returns = 3;
    // 0.01 of slope from row to row: on a level surface 0.9 m below, 3 m away, 10 cm.
    const BearingLine line{.h0 = 1.0F, .h1 = 0.0F, .g0 = 0.0F, .g1 = -0.01F};
    return NearestSlanting(samples, 28, line, limits, window, nearer_than_m);
  }
};

TEST_F(NearestInRows, TakesThreeOfOneSurfaceInARow) {
  EXPECT_EQ(Nearest({5.2F, 3.3F, 3.2F, 3.1F, kPassing}), 3.1F);
  // Missing pixels are passed over; what is as far as the return is not.
  EXPECT_EQ(Nearest({5.2F, 3.3F, kUnusable, 3.2F, 3.1F, kPassing}), 3.1F);
  EXPECT_EQ(Nearest({3.3F, 5.2F, 3.2F, 3.1F}), kPassing);
  EXPECT_EQ(Nearest({3.3F, kPassing, 3.2F, 3.1F}), kPassing);
  EXPECT_EQ(Nearest({3.3F, 3.2F, 3.1F}, 3.3F), kPassing);
  EXPECT_EQ(Nearest({}), kPassing);
}

TEST_F(NearestInRows, LeavesOutWhatLiesElsewhere) {
  // Two wrong pixels beside each other, and one before a surface.
  EXPECT_EQ(Nearest({5.2F, 3.2F, 3.1F, 5.2F, 5.2F}), kPassing);
  EXPECT_EQ(Nearest({3.3F, 3.2F, 3.1F, 1.0F}), 3.1F);
  EXPECT_EQ(Nearest({1.0F, 3.2F, 3.1F, 5.2F}), kPassing);
  // Between two surfaces: each sample far from the next.
  EXPECT_EQ(Nearest({4.5F, 3.0F, 1.8F, 1.0F}), kPassing);
}

}  // namespace
}  // namespace depthgrid
