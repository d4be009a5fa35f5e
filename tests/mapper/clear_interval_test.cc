#include "mapper/scan/clear_interval.h"

#include <gtest/gtest.h>

namespace depthgrid {
namespace {

// Camera at 1.1 m, band 0.1 to 1.8 m: the lower edge is 1 m below, the upper 0.7 m above.
constexpr double kLowCameraM = 1.1;
constexpr SlopeRange kHalfDown{-0.5F, 0.5F};

Distances Clear(const BearingView& view, double limit_m = 6.0, double height_m = kLowCameraM) {
  return ClearInterval(view, height_m, limit_m, ScanOptions{});
}

TEST(ClearInterval, StartsWhereTheLowestRayReachesTheBandsEdge) {
  const Distances clear = Clear({kHalfDown, {}, {}});
  EXPECT_NEAR(clear.from_m, 2.0, 1e-6);
  EXPECT_EQ(clear.to_m, 6.0);
  EXPECT_NEAR(Clear({kHalfDown, {}, {}}, 3.0).to_m, 3.0, 1e-6);
}

TEST(ClearInterval, IsEmptyBeforeThatAndWithoutRays) {
  const Distances near = Clear({kHalfDown, {}, {}}, 1.9);  // the hit is nearer than the view begins
  EXPECT_GE(near.from_m, near.to_m);
  const Distances none = Clear({});
  EXPECT_GE(none.from_m, none.to_m);
  const Distances upwards = Clear({SlopeRange{0.1F, 0.5F}, {}, {}});
  EXPECT_GE(upwards.from_m, upwards.to_m);
}

TEST(ClearInterval, EndsWhereTheHighestRayReachesTheFloor) {
  const Distances clear = Clear({SlopeRange{-1.0F, -0.25F}, {}, {}});
  EXPECT_NEAR(clear.from_m, 1.0, 1e-6);
  EXPECT_NEAR(clear.to_m, 4.0, 1e-6);
}

TEST(ClearInterval, ACameraBelowTheBandLooksUpAtItsEdge) {
  // At 0.05 m: the edge is 0.05 m above.
  const Distances clear = Clear({SlopeRange{-0.5F, 0.1F}, {}, {}}, 6.0, 0.05);
  EXPECT_NEAR(clear.from_m, 0.5, 1e-6);
  EXPECT_EQ(clear.to_m, 6.0);
}

TEST(ClearInterval, AGapHidesWhereItIsTallerThanAllowedAndInsideTheBand) {
  // Between slopes -0.1 and 0.1 nothing is seen: taller than 0.1 m from 0.5 m on, for ever.
  const Distances ahead = Clear({kHalfDown, {}, SlopeRange{-0.1F, 0.1F}});
  EXPECT_GE(ahead.from_m, ahead.to_m);
  // Between -0.4 and -0.3 nothing is seen: from 1 m on, until -0.3 leaves the band at 3.33 m. Of
  // 2 to 6 m the part behind is left.
  const Distances below = Clear({kHalfDown, SlopeRange{-0.4F, -0.3F}, {}});
  EXPECT_NEAR(below.from_m, 1.0 / 0.3, 1e-5);
  EXPECT_EQ(below.to_m, 6.0);
  // A narrow gap grows too tall only beyond 5 m; the part before is left.
  const Distances narrow = Clear({kHalfDown, {}, SlopeRange{0.0F, 0.02F}});
  EXPECT_NEAR(narrow.from_m, 2.0, 1e-6);
  EXPECT_NEAR(narrow.to_m, 5.0, 1e-5);
  // Above, the gap leaves the band through its upper edge: 0.7 / 0.35 = 2 m, where the view begins.
  const Distances above = Clear({kHalfDown, {}, SlopeRange{0.35F, 0.5F}});
  EXPECT_NEAR(above.from_m, 2.0, 1e-5);
  EXPECT_EQ(above.to_m, 6.0);
}

TEST(LaserClearInterval, IsFreeUpToTheLimitOrWhereTheRayLeavesTheBand) {
  const ScanOptions options;
  const auto clear = [&](float slope, double limit_m) {
    return LaserClearInterval({SlopeRange{slope, slope}, {}, {}}, kLowCameraM, limit_m, options);
  };
  EXPECT_EQ(clear(0.0F, 3.0).from_m, 0.0);
  EXPECT_EQ(clear(0.0F, 3.0).to_m, 3.0);
  EXPECT_NEAR(clear(-0.5F, 6.0).to_m, 2.0, 1e-6);
  EXPECT_NEAR(clear(0.35F, 6.0).to_m, 2.0, 1e-6);
  EXPECT_EQ(LaserClearInterval({}, kLowCameraM, 3.0, options).to_m, 0.0);
}

}  // namespace
}  // namespace depthgrid
