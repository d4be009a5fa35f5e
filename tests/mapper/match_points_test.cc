#include "mapper/match/match_points.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

TEST(MatchPoints, AreTheEndPointsOfTheHits) {
  RandomStream random(51, RandomStage::kTest);
  MatchPoints points;
  int cases = 0;
  for (int beams = 0; beams < 40; ++beams) {
    Scan scan;
    for (int i = 0; i < beams; ++i) {
      scan.beams.push_back({.bearing_rad = static_cast<float>(random.Uniform(-4.0, 4.0)),
                            .range_m = static_cast<float>(random.Uniform(0.1, 30.0)),
                            .hit = random.Below(4) != 0});
    }
    points.Assign(scan);
    std::size_t next = 0;
    float farthest_m = 0.0F;
    for (const Beam& beam : scan.beams) {
      if (!beam.hit) continue;
      ASSERT_LT(next, points.x_m.size());
      EXPECT_NEAR(points.x_m[next], EndPoint(beam).x(), 1e-5);
      EXPECT_NEAR(points.y_m[next], EndPoint(beam).y(), 1e-5);
      farthest_m = std::max(farthest_m, beam.range_m);
      ++next;
      ++cases;
    }
    EXPECT_EQ(points.size(), static_cast<int>(next));
    EXPECT_EQ(points.farthest_m, farthest_m);
  }
  EXPECT_GE(cases, 500);
}

}  // namespace
}  // namespace depthgrid
