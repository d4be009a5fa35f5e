// The vectorised search against the plain one it is defined by.
#include "mapper/scan/bearing_returns.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "mapper/core/rng.h"
#include "mapper/scan/slanting.h"
#include "tests/mapper/analytic_room.h"

namespace depthgrid {
namespace {

void ConsiderGap(RowRange& longest, int from, int to) {
  if (to - from > 1 && to - from > longest.last - longest.first) longest = {from, to};
}

BearingReturns PlainReturns(const DepthImage& image, const BearingLine& line,
                            const ReturnLimits& limits, const NoiseWindow& window,
                            bool is_slice = false) {
  const RowRange rows = RowsOf(line, limits);
  BearingReturns returns;
  std::vector<float> samples, heap;
  for (int v = rows.first; v <= rows.last; ++v) {
    samples.push_back(SampleAt(image, line, limits, v));
    if (samples.back() == kUnusable) continue;
    if (returns.seen.last < 0) {
      returns.seen.first = v;
    } else {
      const bool above = line.g0 + line.g1 * static_cast<float>(v) > 0.0F;
      ConsiderGap(above ? returns.gap_above : returns.gap_below, returns.seen.last, v);
    }
    returns.seen.last = v;
  }
  if (is_slice) {
    FindNearest(samples, limits, window, heap, returns);
  } else {
    FindNearestOrSlanting(samples, rows.first, line, limits, window, heap, returns);
  }
  return returns;
}

struct SliceRanges {
  float steady_m = 0.0F, leaning_m = 0.0F;
};
SliceRanges PlainSliceRanges(const DepthImage& image, const BearingLine& line,
                             const SliceBand& slice, const ReturnLimits& limits,
                             const NoiseWindow& window, float range_m) {
  const RowRange rows = RowsOf(line, limits);
  std::vector<float> samples;
  for (int v = rows.first; v <= rows.last; ++v) {
    samples.push_back(SampleAt(image, line, limits, v));
  }
  const float steady_m = SteadyRange(samples, rows.first, line, slice, limits, window, range_m);
  return {steady_m, LeaningRange(samples, rows.first, line, slice, limits, window, steady_m)};
}

// Single pixels that are too near: nearest, but not supported.
void AddStrays(DepthImage& image, double share, RandomStream& random) {
  for (float& z_m : image.z_m) {
    if (random.Uniform() < share) z_m *= 0.7F;
  }
}

// What is seen in the left third leans away from the camera by some 40 degrees.
void LeanLeftThird(DepthImage& image, const PinholeCamera& camera) {
  for (int v = 0; v < image.height_px; ++v) {
    const double up = (camera.cy_px - v) / camera.fy_px;
    for (int u = 0; u < image.width_px / 3; ++u) {
      image.Row(v)[u] *= static_cast<float>(1.0 / std::max(1.0 - 0.8 * up, 0.2));
    }
  }
}

void AddNoise(DepthImage& image, double sigma_m, RandomStream& random) {
  for (float& z_m : image.z_m) {
    if (z_m > 0.0F) z_m += static_cast<float>(sigma_m * random.Normal());
  }
}

// Holes, single wrong pixels, a region that is too near and one too far.
void Damage(DepthImage& image, RandomStream& random) {
  const auto whole = [&](int bound) {
    return static_cast<int>(random.Below(static_cast<std::uint64_t>(bound)));
  };
  for (const float value : {kInvalidDepth, 0.2F, 30.0F, kInvalidDepth}) {
    const int u = whole(image.width_px), v = whole(image.height_px);
    for (int y = v; y < std::min(v + image.height_px / 5, image.height_px); ++y) {
      for (int x = u; x < std::min(u + image.width_px / 5, image.width_px); ++x) {
        image.Row(y)[x] = value;
      }
    }
  }
  for (float& z_m : image.z_m) {
    if (random.Uniform() < 0.02) z_m = kInvalidDepth;
  }
  AddStrays(image, 0.001, random);
}

class InstructionSets : public testing::Test {
 protected:
  ~InstructionSets() override { Choose(0); }
  // 0: all that there are.
  static void Choose(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

TEST_F(InstructionSets, EveryOneGivesThePlainReturnsBitForBit) {
  AnalyticRoom room;
  room.boxes.push_back({{0.9, -1.0, 0.0}, {1.5, -0.3, 0.5}});
  room.cylinders.push_back({{1.4, 0.5}, 0.04, 0.0, 2.5});
  // A step of 2 cm a little above the camera.
  room.boxes.push_back({{0.9, -0.3, 0.0}, {1.5, 0.4, 1.2}});
  room.boxes.push_back({{0.92, -0.3, 1.2}, {1.5, 0.4, 1.4}});
  const std::vector<PinholeCamera> cameras = {
      {160, 120, 120.3, 120.0, 79.5, 59.5, {}},   // columns within two vectors
      {160, 120, 400.0, 400.0, 70.0, 50.0, {}},   // a narrow view
      {240, 100, 180.0, 180.0, 120.0, 50.0, {}},  // more than few columns
      {12, 10, 9.0, 9.0, 5.5, 4.5, {}},           // narrower than two vectors
      {90, 200, 70.0, 80.0, 45.0, 90.0, {}}};
  RandomStream random(11, RandomStage::kTest);
  ReturnsMemory memory;
  BearingFan fan;
  int cases = 0, hits = 0, slice_hits = 0, gaps = 0, unsteady = 0, leaning = 0, narrow = 0;
  for (const std::int64_t target : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    Choose(target);
    for (int i = 0; i < 120; ++i) {
      const PinholeCamera& camera = cameras[static_cast<std::size_t>(i + i / 5) % cameras.size()];
      const double pitch_rad = random.Uniform(-1.0, 1.0) * (i % 3 == 0 ? 1.5 : 0.4);
      const double roll_rad = random.Uniform(-1.0, 1.0) * (i % 5 == 0 ? 3.1 : 0.4);
      const Pose3 pose =
          TiltedCamera({-1.0, 0.1, random.Uniform(-0.5, 0.5)}, 1.15, pitch_rad, roll_rad);
      DepthImage image = room.Render(camera, pose);
      if (i % 5 > 2) LeanLeftThird(image, camera);
      if (i % 4 != 3) AddNoise(image, i % 8 == 2 ? 0.1 : 0.004, random);
      if (i % 4 == 1) AddStrays(image, 0.001, random);
      if (i % 4 > 1) Damage(image, random);
      const Eigen::Quaterniond level = LevelFromCamera(pose);
      const auto lines =
          BearingLines(camera, level, ScanBearings(camera, level, 8 + 37 * (i % 7), fan), false);
      ReturnLimits limits;
      limits.min_depth_m = 0.4F;
      limits.max_range_m = 6.0F;
      limits.low_m = -1.05F;
      limits.high_m = 0.65F;
      limits.min_returns = 1 + i % 4;
      limits.first_row = i % 6 == 0 ? camera.height_px / 3 : 0;
      limits.last_row = camera.height_px - 1;
      const NoiseWindow window(image);
      const SliceBand band{-0.1F, static_cast<float>(0.2 - 0.1), i % 2 == 0 ? 2.5F : 0.0F,
                           i % 3 > 0 ? 6.0F : 0.0F};
      ReturnLimits slice_limits = limits;
      slice_limits.low_m = band.low_m;
      slice_limits.high_m = band.high_m;
      const ImageReturns both = FindReturns(image, lines, limits, band, window, memory);
      ASSERT_EQ(both.size, lines.size());
      const ImageReturns& one = FindReturns(image, lines, limits, {}, window, memory);
      ASSERT_TRUE(one.slice.empty());
      for (std::size_t k = 0; k < lines.size(); ++k) {
        const BearingReturns plain = PlainReturns(image, lines[k], limits, window);
        const BearingReturns returns = both.At(k, both.obstacles);
        ASSERT_EQ(returns.hit, plain.hit) << i << " " << k;
        ASSERT_EQ(returns.range_m, plain.range_m) << i << " " << k;
        ASSERT_EQ(returns.seen, plain.seen) << i << " " << k;
        ASSERT_EQ(returns.gap_below, plain.gap_below) << i << " " << k;
        ASSERT_EQ(returns.gap_above, plain.gap_above) << i << " " << k;
        ASSERT_EQ(one.At(k, one.obstacles), returns) << i << " " << k;
        BearingReturns plain_slice = PlainReturns(image, lines[k], slice_limits, window, true);
        if (plain_slice.hit) {
          const float whole_m = plain_slice.range_m;
          const auto [steady_m, leaning_m] =
              PlainSliceRanges(image, lines[k], band, slice_limits, window, whole_m);
          plain_slice.range_m = leaning_m;
          unsteady += steady_m != whole_m ? 1 : 0;
          leaning += leaning_m != steady_m ? 1 : 0;
        }
        ASSERT_EQ(both.At(k, both.slice), plain_slice) << i << " " << k;
        slice_hits += plain_slice.hit ? 1 : 0;
        ++cases;
        hits += plain.hit ? 1 : 0;
        narrow += plain.hit && NoiseWindow::IsCapped(window.At(plain.range_m)) ? 1 : 0;
        gaps += plain.gap_below.last > 0 || plain.gap_above.last > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(cases, 4000);
  EXPECT_GE(hits, 2000);
  EXPECT_GE(slice_hits, 2000);
  EXPECT_GE(unsteady, 50);
  EXPECT_GE(leaning, 50);
  EXPECT_GE(narrow, 100);
  EXPECT_GE(gaps, 600);
}

// A wall behind a wide near thing need not be looked at, unless it is what a gap in the thing shows
// where only a stray sample is nearer.
TEST_F(InstructionSets, AWallFarBehindCountsWhereNearSamplesAreAlone) {
  const PinholeCamera camera{160, 120, 120.0, 120.0, 79.5, 59.5, {}};
  DepthImage image;
  image.width_px = camera.width_px;
  image.height_px = camera.height_px;
  image.z_m.assign(160 * 120, 3.0F);
  for (int v = 48; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool is_gap = u >= 70 && u < 74;  // shows the floor far away
      image.Row(v)[u] = !is_gap ? 1.0F : v == 100 ? 0.9F : 30.0F;
    }
  }
  const Eigen::Quaterniond level = LevelFromCamera(TiltedCamera({}, 1.15, 0.0, 0.0));
  BearingFan fan;
  const auto lines = BearingLines(camera, level, ScanBearings(camera, level, 160, fan), false);
  const ReturnLimits limits{0.4F, 6.0F, -1.05F, 2.0F, 3, 0, 119};
  const NoiseWindow window(image);
  ReturnsMemory memory;
  const ImageReturns& all = FindReturns(image, lines, limits, {}, window, memory);
  int near = 0, far = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const BearingReturns returns = all.At(k, all.obstacles);
    ASSERT_EQ(returns, PlainReturns(image, lines[k], limits, window)) << k;
    (returns.range_m < 2.0F ? near : far) += returns.hit ? 1 : 0;
  }
  EXPECT_GE(near, 150);
  EXPECT_GE(far, 3);
}

TEST(FindNearest, NeedsSupportAndAveragesTheWindow) {
  const NoiseWindow window{DepthImage(8, 8)};  // nothing measured: the default noise
  const float width_m = window.At(2.0F);
  ASSERT_GT(width_m, 0.02F);
  ReturnLimits limits;
  limits.min_returns = 3;
  const auto nearest = [&](std::vector<float> samples) {
    BearingReturns returns;
    std::vector<float> heap;
    FindNearest(samples, limits, window, heap, returns);
    return returns.hit ? returns.range_m : -1.0F;
  };
  // 1.5 stands alone; 2.00 to 2.02 belong together; 3 is behind.
  EXPECT_FLOAT_EQ(nearest({3.0F, 2.02F, 1.5F, 2.00F, 2.01F, 3.0F, kPassing, kUnusable}), 2.01F);
  EXPECT_EQ(nearest({1.5F, 2.5F, 3.5F, kPassing, kPassing, kPassing}), -1.0F);
  EXPECT_EQ(nearest({}), -1.0F);
  limits.min_returns = 1;
  EXPECT_EQ(nearest({3.0F, 1.5F, 2.0F}), 1.5F);
}

TEST(DepthBetween, InterpolatesASurfaceAndJumpsAtAnEdge) {
  EXPECT_FLOAT_EQ(DepthBetween(2.0F, 2.04F, 0.25F), 2.01F);
  EXPECT_EQ(DepthBetween(2.0F, 3.0F, 0.4F), 2.0F);
  EXPECT_EQ(DepthBetween(2.0F, 3.0F, 0.6F), 3.0F);
  EXPECT_EQ(DepthBetween(kInvalidDepth, 3.0F, 0.1F), 3.0F);  // the other pixel stands in
  EXPECT_EQ(DepthBetween(2.0F, kInvalidDepth, 0.9F), 2.0F);
  EXPECT_EQ(DepthBetween(kInvalidDepth, kInvalidDepth, 0.5F), kInvalidDepth);
}

TEST(DepthBetween, OfFewColumnsGoesOnAlongAWallThatRecedes) {
  // 1/z is linear: .5 .45 .40 .35.
  const float a = 2.0F, b = 1.0F / 0.45F, c = 2.5F, e = 1.0F / 0.35F;
  EXPECT_FLOAT_EQ(DepthBetweenFew(a, b, c, e, 0.2F), 1.0F / 0.44F);
  EXPECT_FLOAT_EQ(DepthBetweenFew(a, b, c, 9.0F, 0.2F), 1.0F / 0.44F);  // one neighbour is enough
  EXPECT_FLOAT_EQ(DepthBetweenFew(kInvalidDepth, b, c, e, 0.2F), 1.0F / 0.44F);
  EXPECT_EQ(DepthBetweenFew(b, b, c, c, 0.2F), b);        // an edge
  EXPECT_EQ(DepthBetweenFew(a, b, 4.0F, 4.1F, 0.2F), b);  // the same beside a wall that recedes
  EXPECT_EQ(DepthBetweenFew(b, b, c, c, 0.8F), c);
  EXPECT_EQ(DepthBetweenFew(b, c, kInvalidDepth, e, 0.8F), c);
  EXPECT_EQ(DepthBetweenFew(a, kInvalidDepth, c, e, 0.2F), c);
  EXPECT_EQ(DepthBetweenFew(kInvalidDepth, b, c, kInvalidDepth, 0.2F), b);
}

}  // namespace
}  // namespace depthgrid
