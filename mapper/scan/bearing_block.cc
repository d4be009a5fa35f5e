#include "mapper/scan/bearing_block.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_block.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>
// Must follow foreach_target.h.
#include <hwy/cache_control.h>

#include "mapper/scan/bearing_stripe-inl.h"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

// Bounds of linear functions over a range of rows: the minimum of the functions is nowhere below
// its chord between the end rows, the maximum nowhere above.
struct ChordBounds {
  AlongRows least, most;
};
ChordBounds BoundLinear(const BearingBlock& block, const float* at_0, const float* per_row) {
  const Floats d;
  const Vec f0 = hn::Load(d, at_0), f1 = hn::Load(d, per_row);
  const auto first = static_cast<float>(block.rows.first);
  const auto last = static_cast<float>(block.rows.last);
  const Vec at_first = hn::Add(f0, hn::Mul(f1, hn::Set(d, first)));
  const Vec at_last = hn::Add(f0, hn::Mul(f1, hn::Set(d, last)));
  // Relative rounding error of single-precision sums and products (2^-24 each), here and in the
  // samples.
  constexpr float kRounding = 2e-6F;
  const Vec size = hn::Add(hn::Abs(f0), hn::Mul(hn::Abs(f1), hn::Set(d, last)));
  const float spare = kRounding * hn::GetLane(hn::MaxOfLanes(d, size));
  const auto chord = [&](float from, float to) {
    const float slope = (to - from) / std::max(last - first, 1.0F);
    return AlongRows{from - slope * first, slope};
  };
  return {chord(hn::GetLane(hn::MinOfLanes(d, at_first)) - spare,
                hn::GetLane(hn::MinOfLanes(d, at_last)) - spare),
          chord(hn::GetLane(hn::MaxOfLanes(d, at_first)) + spare,
                hn::GetLane(hn::MaxOfLanes(d, at_last)) + spare)};
}

void SmallestOfGroups(const float* HWY_RESTRICT groups, std::size_t count, BlockLane& smallest) {
  const Floats d;
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    Vec least = hn::Load(d, groups + i);
    for (std::size_t g = 1; g < count; ++g) {
      least = hn::Min(least, hn::Load(d, groups + g * kBlockBearings + i));
    }
    hn::Store(least, d, &smallest[i]);
  }
}

RowRange RowsOfGroup(const ReturnLimits& limits, std::size_t group) {
  const int from = limits.first_row + static_cast<int>(group * kGroupRows);
  return {from, std::min(from + static_cast<int>(kGroupRows) - 1, limits.last_row)};
}

// Prefetches the columns of the next group, a few per tile: the hardware prefetcher does not follow
// strides of a whole row, and only about a dozen prefetches can be in flight.
class Fetching {
 public:
  Fetching(const DepthImage& image, int next_row, const Survey& survey, std::size_t tiles)
      : width_(image.width_px), tiles_(tiles) {
    if (next_row < 0 || survey.first >= survey.end) return;
    next_ = image.Row(next_row) + survey.first;
    lines_ = (static_cast<std::size_t>(survey.end - survey.first) + kLineFloats - 1) / kLineFloats;
  }
  void WithTile() {
    for (due_ += lines_; due_ >= tiles_; due_ -= tiles_, next_ += kLineFloats) {
      const float* to = next_;
      for (std::size_t r = 0; r < kGroupRows; ++r, to += width_) hwy::Prefetch(to);
    }
  }

 private:
  static constexpr std::size_t kLineFloats = 16;
  std::ptrdiff_t width_;
  std::size_t tiles_, lines_ = 0, due_ = 0;
  const float* next_ = nullptr;
};

// Collects the bounds of the vectors of all blocks.
StripeVectors VectorsOf(std::span<const BearingBlock> blocks, int width) {
  const std::size_t lanes = hn::Lanes(Floats());
  const bool is_wide = width >= static_cast<int>(2 * lanes);
  StripeVectors vectors;
  vectors.count = blocks.size() * kBlockBearings / lanes;
  for (std::size_t i = 0; i < kMostTiles; ++i) {
    const std::size_t k = std::min(i, vectors.count - 1);
    const std::size_t of = k * lanes / kBlockBearings, lane = k * lanes % kBlockBearings;
    const BearingBlock& block = blocks[of];
    const ChordBounds height = BoundLinear(block, &block.lines->g0[lane], &block.lines->g1[lane]);
    const ChordBounds range = BoundLinear(block, &block.lines->h0[lane], &block.lines->h1[lane]);
    vectors.of[i] = of;
    vectors.lane[i] = lane;
    vectors.rows_first[i] = static_cast<float>(block.rows.first);
    vectors.rows_last[i] = static_cast<float>(block.rows.last);
    vectors.shared_first[i] = static_cast<float>(block.shared_rows.first);
    vectors.shared_last[i] = static_cast<float>(block.shared_rows.last);
    vectors.is_known[i] = is_wide && block.all_ahead ? 1.0F : 0.0F;
    vectors.left.Put(i, {block.lines->u0[lane], block.lines->u1[lane]});
    vectors.right.Put(i, {block.lines->u0[lane + lanes - 1], block.lines->u1[lane + lanes - 1]});
    vectors.lowest.Put(i, height.least);
    vectors.highest.Put(i, height.most);
    vectors.shortest.Put(i, range.least);
  }
  return vectors;
}

// A stripe of the image.
struct StripeJob {
  const ImageBands& bands;
  const SkipRule& rule;
  std::span<const BearingBlock> blocks;
  std::span<BlockSamples> found;
};

void SampleGroup(const StripeJob& job, std::size_t group, StripeVectors& vectors, Survey& survey) {
  const Floats d;
  const DepthImage& image = job.bands.image;
  const ReturnLimits& limits = job.bands.limits;
  const RowRange rows = RowsOfGroup(limits, group);
  GroupTiles tiles;
  // The skip limits of two groups ago are still valid and nearly as good.
  if (group % 2 == 0) FindSkipFrom(job.rule, job.found, vectors);
  LayOut(vectors, image.width_px, rows, tiles);
  SurveyColumns(image, rows, tiles.first_column, tiles.end_column, survey);
  FindContents(job.bands, vectors, rows, survey, tiles);
  const int next_row = group > 0 ? RowsOfGroup(limits, group - 1).first : -1;
  Fetching fetching(image, next_row, survey, vectors.count);
  for (std::size_t i = 0; i < vectors.count; ++i) {
    fetching.WithTile();
    if (tiles.rows[i] == 0) continue;
    const RowRange own{rows.first, rows.first + tiles.rows[i] - 1};
    const Tile tile{&job.bands,     &job.blocks[vectors.of[i]], vectors.lane[i],     own,
                    tiles.start[i], tiles.columns[i],           tiles.inside[i] != 0};
    BlockSamples& out = job.found[vectors.of[i]];
    const auto content = static_cast<Content>(tiles.content[i]);
    hn::Store(hn::Set(d, tiles.usable_from[i]), d, out.band.samples.least_depth + tile.AtGroup());
    SampleAs(content, tile, out);
    if (IsFar(content)) {
      vectors.skipped_from[i] = std::min(vectors.skipped_from[i], tiles.range_from[i]);
    }
  }
}

void SampleAll(const ImageBands& bands, const SkipWidths& widths,
               std::span<const BearingBlock> blocks, std::vector<float>& memory,
               std::span<BlockSamples> found) {
  const Floats d;
  const SkipRule rule(widths, bands.limits.max_range_m);
  StripeVectors vectors = VectorsOf(blocks, bands.image.width_px);
  vectors.skip_from.fill(std::numeric_limits<float>::infinity());
  vectors.skipped_from.fill(std::numeric_limits<float>::infinity());
  Survey survey(bands.image.width_px, memory);
  const auto rows = static_cast<std::size_t>(bands.limits.last_row - bands.limits.first_row + 1);
  for (std::size_t group = (rows + kGroupRows - 1) / kGroupRows; group-- > 0;) {
    SampleGroup({bands, rule, blocks, found}, group, vectors, survey);
  }
  for (std::size_t i = 0; i < vectors.count; ++i) {
    float* const skipped_from = &found[vectors.of[i]].band.skipped_from[vectors.lane[i]];
    hn::Store(hn::Set(d, vectors.skipped_from[i]), d, skipped_from);
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b].GroupCount() == 0) continue;  // none of its lines is in the image
    SmallestOfGroups(found[b].band.samples.least_depth, blocks[b].GroupCount(),
                     found[b].least_depth);
  }
}

void SampleRest(const ImageBands& bands, const BearingBlock& block, std::size_t of_lane,
                BlockSamples& found) {
  const Floats d;
  const std::size_t lane = of_lane / hn::Lanes(d) * hn::Lanes(d);
  for (std::size_t group = 0; group < block.GroupCount(); ++group) {
    const Tile tile{&bands, &block, lane, block.RowsOfGroup(group)};
    if (found.band.samples.nearest[tile.AtGroup()] != kSkipped) continue;
    SampleAs(Content::kNoSlice, tile, found);
  }
  hn::Store(hn::Set(d, std::numeric_limits<float>::infinity()), d, &found.band.skipped_from[lane]);
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SampleAll);
HWY_EXPORT(SampleRest);

void SampleBlocks(const ImageBands& bands, const SkipWidths& widths,
                  std::span<const BearingBlock> blocks, std::vector<float>& survey,
                  std::span<BlockSamples> found) {
  for (BlockSamples& block : found) {
    block.band.nearest.fill(kUnusable);
    block.slice.nearest.fill(kPassing);
    block.slice.skipped_from.fill(std::numeric_limits<float>::infinity());
  }
  HWY_DYNAMIC_DISPATCH(SampleAll)(bands, widths, blocks, survey, found);
}

void SampleSkipped(const ImageBands& bands, const BearingBlock& block, std::size_t lane,
                   BlockSamples& found) {
  HWY_DYNAMIC_DISPATCH(SampleRest)(bands, block, lane, found);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
