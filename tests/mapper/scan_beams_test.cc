#include "mapper/scan/scan_beams.h"

#include <gtest/gtest.h>

#include "mapper/core/rng.h"
#include "mapper/scan/clear_interval.h"

namespace depthgrid {
namespace {

float SlopeAt(const BearingLine& line, int v) {
  const auto row = static_cast<float>(v);
  return (line.g0 + line.g1 * row) / (line.h0 + line.h1 * row);
}

std::optional<SlopeRange> SlopesOf(const BearingLine& line, const RowRange& rows) {
  if (rows.first > rows.last) return {};
  const float a = SlopeAt(line, rows.first), b = SlopeAt(line, rows.last);
  return SlopeRange{std::min(a, b), std::max(a, b)};
}

// Some rows of 480, or none.
RowRange RowsBetween(int low, int high, RandomStream& random) {
  const int first = low + static_cast<int>(random.Uniform() * (high - low));
  return {first, first + 2 + static_cast<int>(random.Uniform() * (high - first))};
}

struct Image {
  std::vector<Bearing> bearings;
  BearingLineTable lines;
  ImageReturns returns;
};

void PutRows(BlockLane& from, BlockLane& to, std::size_t lane, const RowRange& rows) {
  from[lane] = static_cast<float>(rows.first);
  to[lane] = static_cast<float>(rows.last);
}

// Lines of a camera of 480 rows that looks a little up or down.
Image RandomImage(std::size_t beams, bool gaps, RandomStream& random) {
  Image image;
  image.lines.Resize(beams);
  image.returns.views.resize(image.lines.blocks.size());
  image.returns.obstacles.resize(image.lines.blocks.size());
  for (std::size_t k = 0; k < beams; ++k) {
    image.bearings.push_back({0.001 * static_cast<double>(k), 1.0, 0.0});
    const auto pitch = static_cast<float>(random.Uniform(-0.6, 0.6));
    const std::size_t block = k / kBlockBearings, lane = k % kBlockBearings;
    BearingLineBlock& lines = image.lines.blocks[block];
    lines.g0[lane] = 0.45F + pitch;
    lines.g1[lane] = -0.9F / 480.0F;
    lines.h0[lane] = 1.0F - 0.3F * pitch;
    lines.h1[lane] = 0.0005F * pitch;
    BlockViews& views = image.returns.views[block];
    BlockHits& hits = image.returns.obstacles[block];
    const bool is_hit = random.Uniform() < 0.7;
    hits.is_hit[lane] = is_hit ? 1.0F : 0.0F;
    hits.range_m[lane] = is_hit ? static_cast<float>(random.Uniform(0.4, 6.0)) : 0.0F;
    const auto maybe = [&](double share, int low, int high) {
      return random.Uniform() < share ? RowsBetween(low, high, random) : RowRange{};
    };
    PutRows(views.first, views.last, lane, maybe(0.95, 0, 400));
    PutRows(views.below_from, views.below_to, lane, maybe(gaps ? 0.5 : 0.0, 240, 440));
    PutRows(views.above_from, views.above_to, lane, maybe(gaps ? 0.5 : 0.0, 0, 200));
    views.has_gaps = gaps;
  }
  return image;
}

TEST(ScanBeams, AreClearWhereClearIntervalSaysBitForBit) {
  RandomStream random(5, RandomStage::kTest);
  int clear_beams = 0, changed_by_gaps = 0;
  for (int i = 0; i < 60; ++i) {
    ScanOptions options;
    options.max_range_m = i % 2 == 0 ? 6.0 : 5.3;
    if (i % 4 == 3) options.mode = ScanMode::kRowBand;
    const double height_m = i % 5 == 0 ? 0.05 : random.Uniform(0.3, 1.6);
    const Image image = RandomImage(1 + 37 * static_cast<std::size_t>(i % 7), i % 3 > 0, random);
    BearingViews views;
    BeamNumbers memory;
    FindViews(image.lines, image.returns.views, views);
    const Scan scan =
        ScanOf(image.bearings, views, image.returns.obstacles, height_m, options, memory, Scan{});
    ASSERT_EQ(scan.beams.size(), image.lines.size());
    ASSERT_EQ(scan.max_range_m, options.max_range_m);
    for (std::size_t k = 0; k < scan.beams.size(); ++k) {
      const BearingLine line = image.lines[k];
      const BearingReturns returns = image.returns.At(k, image.returns.obstacles);
      const BearingView view{SlopesOf(line, returns.seen), SlopesOf(line, returns.gap_below),
                             SlopesOf(line, returns.gap_above)};
      const double limit_m = returns.hit ? returns.range_m : options.max_range_m;
      const auto interval = options.mode == ScanMode::kFull ? ClearInterval : LaserClearInterval;
      const Distances clear = interval(view, height_m, limit_m, options);
      const Beam expected{static_cast<float>(image.bearings[k].angle_rad), returns.range_m,
                          static_cast<float>(clear.from_m), static_cast<float>(clear.to_m),
                          returns.hit};
      ASSERT_EQ(scan.beams[k], expected) << i << " " << k;
      const Distances without = interval({view.seen, {}, {}}, height_m, limit_m, options);
      clear_beams += clear.from_m < clear.to_m ? 1 : 0;
      changed_by_gaps += without.from_m != clear.from_m || without.to_m != clear.to_m ? 1 : 0;
    }
  }
  EXPECT_GE(clear_beams, 1000);
  EXPECT_GE(changed_by_gaps, 300);
}

}  // namespace
}  // namespace depthgrid
