#include "mapper/scan/bearing_block.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

// x86-64-v3 has AVX2 without AES, which nothing here needs.
#define HWY_DISABLE_PCLMUL_AES
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_block.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>
// After the above.
#include <hwy/cache_control.h>

#include "mapper/scan/bearing_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

// Between two rows the smallest of linear functions is nowhere below its chord, the largest nowhere
// above.
struct ChordBounds {
  LinearBound least, most;
};
ChordBounds BoundLinear(const BearingBlock& block, const float* at_0, const float* per_row) {
  const Floats d;
  const Vec f0 = hn::Load(d, at_0), f1 = hn::Load(d, per_row);
  const auto first = static_cast<float>(block.rows.first);
  const auto last = static_cast<float>(block.rows.last);
  const Vec at_first = hn::Add(f0, hn::Mul(f1, hn::Set(d, first)));
  const Vec at_last = hn::Add(f0, hn::Mul(f1, hn::Set(d, last)));
  // Of sums and products in single precision, here and of each sample: 2^-24 each.
  constexpr float kRounding = 2e-6F;
  const Vec size = hn::Add(hn::Abs(f0), hn::Mul(hn::Abs(f1), hn::Set(d, last)));
  const float spare = kRounding * hn::GetLane(hn::MaxOfLanes(d, size));
  const auto chord = [&](float from, float to) {
    const float slope = (to - from) / std::max(last - first, 1.0F);
    return LinearBound{from - slope * first, slope};
  };
  return {chord(hn::GetLane(hn::MinOfLanes(d, at_first)) - spare,
                hn::GetLane(hn::MinOfLanes(d, at_last)) - spare),
          chord(hn::GetLane(hn::MaxOfLanes(d, at_first)) + spare,
                hn::GetLane(hn::MaxOfLanes(d, at_last)) + spare)};
}

VectorBounds BoundsOf(const BearingBlock& block, std::size_t lane) {
  const ChordBounds height = BoundLinear(block, &block.g0[lane], &block.g1[lane]);
  const ChordBounds range = BoundLinear(block, &block.h0[lane], &block.h1[lane]);
  return {height.least, height.most, range.least};
}

// Of all pixels that any sample of a tile is made of, and so of the samples.
struct DepthRange {
  float least = 0.0F;
  float most = std::numeric_limits<float>::infinity();
};

DepthRange DepthOf(const Tile& tile, const std::vector<float>& survey) {
  if (tile.columns == 0) return {};
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float* HWY_RESTRICT columns = survey.data() + tile.start;
  const float* HWY_RESTRICT greatest = columns + tile.bands->image.width_px;
  Vec least = hn::LoadU(d, columns), most = hn::LoadU(d, greatest);
  for (int at = lanes; at < tile.columns; at += lanes) {
    const int from = std::min(at, tile.columns - lanes);
    least = hn::Min(least, hn::LoadU(d, columns + from));
    most = hn::Max(most, hn::LoadU(d, greatest + from));
  }
  return {hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, most))};
}

Content ContentOf(const Tile& tile, const VectorBounds& bounds, const DepthRange& depth) {
  const ReturnLimits& limits = tile.bands->limits;
  const float near = std::max(depth.least, limits.min_depth_m);  // of what is usable
  const float low = bounds.lowest.LeastOf(tile.rows), high = bounds.highest.MostOf(tile.rows);
  const float bottom = std::min(near * low, depth.most * low);
  const float top = std::max(near * high, depth.most * high);
  const auto outside = [&](float from_m, float to_m) { return top < from_m || bottom > to_m; };
  if (!tile.block->AreShared(tile.rows) ||
      !outside(tile.bands->slice.low_m, tile.bands->slice.high_m))
    return Content::kAnything;
  if (depth.least < limits.min_depth_m) return Content::kNoSlice;
  if (outside(limits.low_m, limits.high_m)) return Content::kPassing;
  if (bottom < limits.low_m || top > limits.high_m) return Content::kNoSlice;
  // A little less, for what DepthBetween rounds.
  constexpr float kSurfaceShare = 0.999F * kSameSurfaceShare;
  const bool surface = depth.most - depth.least <= kSurfaceShare * depth.least;
  return surface ? Content::kSurface : Content::kInBand;
}

// Widths of the noise window by range. Whether what is skipped was far enough is seen afterwards.
class SkipRule {
 public:
  SkipRule(const NoiseWindow& window, float max_range_m) : max_range_m_(max_range_m) {
    for (std::size_t k = 0; k < kSteps; ++k) {
      width_m_[k] = window.At(kStepM * static_cast<float>(k + 1));
    }
  }
  // From where on samples do not matter once each lane has one as near as this: the second mean
  // looks half a window beyond the first.
  float From(float nearest_m) const {
    if (!(nearest_m < max_range_m_)) return max_range_m_;
    const auto step = static_cast<std::size_t>(nearest_m / kStepM);
    return std::min(nearest_m + 1.5F * width_m_[std::min(step, kSteps - 1)], max_range_m_);
  }

 private:
  static constexpr std::size_t kSteps = 32;
  static constexpr float kStepM = 0.25F;
  std::array<float, kSteps> width_m_{};
  float max_range_m_;
};

void SampleOneTile(const Tile& tile, const std::vector<float>& survey, const SkipRule& rule,
                   const VectorBounds& bounds, BlockSamples& out) {
  const Floats d;
  const DepthRange depth = DepthOf(tile, survey);
  hn::Store(hn::Set(d, depth.least), d, out.band.samples.least_depth + tile.AtGroup());
  const Content content = ContentOf(tile, bounds, depth);
  if (content == Content::kPassing) return SampleAs(content, tile, out);
  if (content != Content::kAnything && depth.least >= tile.bands->limits.min_depth_m) {
    const float from_m = depth.least * bounds.shortest.LeastOf(tile.rows);
    const Vec nearest = hn::Load(d, &out.band.nearest[tile.lane]);
    if (from_m > rule.From(hn::GetLane(hn::MaxOfLanes(d, nearest)))) {
      float* const skipped_from = &out.band.skipped_from[tile.lane];
      hn::Store(hn::Min(hn::Load(d, skipped_from), hn::Set(d, from_m)), d, skipped_from);
      return StoreNearest(tile, hn::Set(d, kSkipped), hn::Set(d, kPassing), out);
    }
  }
  SampleAs(content, tile, out);
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

// Some columns of the next group, a few with each tile: the processor does not foresee steps of a
// whole row, and takes no more than a dozen at once.
void FetchAhead(const float* pixels, int columns, int width) {
  constexpr int kLineFloats = 16;
  for (int at = 0; at < columns; at += kLineFloats) {
    const float* to = pixels + at;
    for (std::size_t r = 0; r < kGroupRows; ++r, to += width) hwy::Prefetch(to);
  }
}

void SampleGroup(const ImageBands& bands, const SkipRule& rule, std::size_t group,
                 std::span<const BearingBlock> blocks, std::vector<float>& survey,
                 std::span<BlockSamples> found) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::array<Tile, kStripeBlocks * kBlockBearings / hn::MaxLanes(Floats())> tiles;
  std::size_t count = 0;
  int first = bands.image.width_px, end = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const BearingBlock& block = blocks[b];
    if (group < block.first_group || group - block.first_group >= block.GroupCount()) continue;
    const RowRange rows = block.RowsOfGroup(group - block.first_group);
    for (std::size_t lane = 0; lane < kBlockBearings; lane += lanes) {
      Tile& tile = tiles[count++];
      tile = {&bands, &block, b, lane, rows};
      FindColumns(tile);
      if (tile.columns == 0) continue;
      first = std::min(first, tile.start);
      end = std::max(end, tile.start + tile.columns);
    }
  }
  SurveyColumns(bands.image, RowsOfGroup(bands.limits, group), first, end, survey);
  const float* above =
      group > 0 ? bands.image.Row(RowsOfGroup(bands.limits, group - 1).first) : nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    if (above != nullptr) {
      const auto part = [&](std::size_t k) {
        return first + static_cast<int>(k) * (end - first) / static_cast<int>(count);
      };
      FetchAhead(above + part(i), part(i + 1) - part(i), bands.image.width_px);
    }
    BlockSamples& out = found[tiles[i].of];
    SampleOneTile(tiles[i], survey, rule, out.bounds[tiles[i].lane / lanes], out);
  }
}

void SampleAll(const ImageBands& bands, const NoiseWindow& window,
               std::span<const BearingBlock> blocks, std::vector<float>& survey,
               std::span<BlockSamples> found) {
  const std::size_t lanes = hn::Lanes(Floats());
  const std::size_t vectors = kBlockBearings / lanes;
  const SkipRule rule(window, bands.limits.max_range_m);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t k = 0; k < vectors; ++k) {
      found[b].bounds[k] = BoundsOf(blocks[b], k * lanes);
    }
  }
  const auto rows = static_cast<std::size_t>(bands.limits.last_row - bands.limits.first_row + 1);
  for (std::size_t group = (rows + kGroupRows - 1) / kGroupRows; group-- > 0;) {
    SampleGroup(bands, rule, group, blocks, survey, found);
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    SmallestOfGroups(found[b].band.samples.least_depth, blocks[b].GroupCount(),
                     found[b].least_depth);
  }
}

void SampleRest(const ImageBands& bands, const BearingBlock& block, BlockSamples& found) {
  const Floats d;
  for (std::size_t group = 0; group < block.GroupCount(); ++group) {
    for (std::size_t lane = 0; lane < kBlockBearings; lane += hn::Lanes(d)) {
      Tile tile{&bands, &block, 0, lane, block.RowsOfGroup(group)};
      if (found.band.samples.nearest[tile.AtGroup()] != kSkipped) continue;
      FindColumns(tile);
      SampleAs(Content::kNoSlice, tile, found);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SampleAll);
HWY_EXPORT(SampleRest);

void SampleBlocks(const ImageBands& bands, const NoiseWindow& window,
                  std::span<const BearingBlock> blocks, std::vector<float>& survey,
                  std::span<BlockSamples> found) {
  for (BlockSamples& block : found) {
    block.band.nearest.fill(kUnusable);
    block.slice.nearest.fill(kPassing);
    block.band.skipped_from.fill(std::numeric_limits<float>::infinity());
    block.slice.skipped_from.fill(std::numeric_limits<float>::infinity());
  }
  HWY_DYNAMIC_DISPATCH(SampleAll)(bands, window, blocks, survey, found);
}

void SampleSkipped(const ImageBands& bands, const BearingBlock& block, BlockSamples& found) {
  HWY_DYNAMIC_DISPATCH(SampleRest)(bands, block, found);
  found.band.skipped_from.fill(std::numeric_limits<float>::infinity());
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
