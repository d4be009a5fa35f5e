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

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBlockBearings>;
using Ints = hn::RebindToSigned<Floats>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

// Linear in the row.
struct SlopeBound {
  float at_0 = 0.0F, per_row = 0.0F;
  float At(int row) const { return at_0 + per_row * static_cast<float>(row); }
  float LeastOf(const RowRange& rows) const { return std::min(At(rows.first), At(rows.last)); }
  float MostOf(const RowRange& rows) const { return std::max(At(rows.first), At(rows.last)); }
};

// No ray of a vector's lanes rises less or more a depth, rounding included.
struct SlopeBounds {
  SlopeBound lowest, highest;
};

// Between two rows the smallest of linear functions is nowhere below its chord, the largest nowhere
// above.
SlopeBounds BoundSlopes(const BearingBlock& block, std::size_t lane) {
  const Floats d;
  const Vec g0 = hn::Load(d, &block.g0[lane]), g1 = hn::Load(d, &block.g1[lane]);
  const auto first = static_cast<float>(block.rows.first);
  const auto last = static_cast<float>(block.rows.last);
  const Vec at_first = hn::Add(g0, hn::Mul(g1, hn::Set(d, first)));
  const Vec at_last = hn::Add(g0, hn::Mul(g1, hn::Set(d, last)));
  // Of sums and products in single precision, here and of each sample: 2^-24 each.
  constexpr float kRounding = 2e-6F;
  const Vec size = hn::Add(hn::Abs(g0), hn::Mul(hn::Abs(g1), hn::Set(d, last)));
  const float spare = kRounding * hn::GetLane(hn::MaxOfLanes(d, size));
  const auto chord = [&](float from, float to) {
    const float per_row = (to - from) / std::max(last - first, 1.0F);
    return SlopeBound{from - per_row * first, per_row};
  };
  return {chord(hn::GetLane(hn::MinOfLanes(d, at_first)) - spare,
                hn::GetLane(hn::MinOfLanes(d, at_last)) - spare),
          chord(hn::GetLane(hn::MaxOfLanes(d, at_first)) + spare,
                hn::GetLane(hn::MaxOfLanes(d, at_last)) + spare)};
}

// The lanes of one vector and a group of rows.
struct Tile {
  const DepthImage& image;
  const ReturnLimits& limits;
  const SliceBand& slice;
  const BearingBlock& block;
  std::size_t lane;  // the first, in the block
  RowRange rows;
  // First of the pixels that any sample is made of, and how many side by side; 0 when not known.
  int start = 0;
  int columns = 0;

  std::size_t RowCount() const { return static_cast<std::size_t>(rows.last - rows.first + 1); }
  // Where samples and groups of the tile lie in the block.
  std::size_t AtRow() const {
    return static_cast<std::size_t>(rows.first - block.rows.first) * kBlockBearings + lane;
  }
  std::size_t AtGroup() const {
    const auto row = static_cast<std::size_t>(rows.first - block.rows.first);
    return row / kGroupRows * kBlockBearings + lane;
  }
};

// Columns are monotonic in the row, and in the bearing while all rays look ahead: the corners bound
// them. Two vectors from `start` on are in the image.
void FindColumns(Tile& tile) {
  const std::size_t lanes = hn::Lanes(Floats());
  const BearingBlock& block = tile.block;
  const int max_start = tile.image.width_px - static_cast<int>(2 * lanes);
  if (!block.all_ahead || max_start < 0) return;
  float least = LastColumn(tile.image.width_px), most = 0.0F;
  for (const std::size_t lane : {tile.lane, tile.lane + lanes - 1}) {
    for (const int v : {tile.rows.first, tile.rows.last}) {
      const float u = block.u0[lane] + block.u1[lane] * static_cast<float>(v);
      least = std::min(least, u);
      most = std::max(most, u);
    }
  }
  const int last = static_cast<int>(std::min(most, LastColumn(tile.image.width_px))) + 1;
  tile.start = std::min(static_cast<int>(std::max(least, 0.0F)), max_start);
  tile.columns = std::max(last - tile.start + 1, static_cast<int>(lanes));
}

// Of all pixels that any sample of a tile is made of, and so of the samples.
struct DepthRange {
  float least = 0.0F;
  float most = std::numeric_limits<float>::infinity();
};

DepthRange SurveyDepth(const Tile& tile) {
  if (tile.columns == 0) return {};
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::ptrdiff_t width = tile.image.width_px;
  // The next group; the processor does not foresee steps of a whole image row.
  const bool has_next = tile.rows.last + static_cast<int>(kGroupRows) < tile.image.height_px;
  const std::ptrdiff_t ahead = has_next ? static_cast<std::ptrdiff_t>(kGroupRows) * width : 0;
  Vec least = hn::Set(d, kUnusable), most = hn::Zero(d);
  for (int at = 0; at < tile.columns; at += lanes) {
    const float* HWY_RESTRICT pixels =
        tile.image.Row(tile.rows.first) + tile.start + std::min(at, tile.columns - lanes);
    for (std::size_t r = 0; r < tile.RowCount(); ++r, pixels += width) {
      if (at == 0) hwy::Prefetch(pixels + ahead);
      const Vec z = hn::LoadU(d, pixels);
      least = hn::Min(least, z);
      most = hn::Max(most, z);
    }
  }
  return {hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, most))};
}

// What a tile holds.
enum class Content : std::uint8_t {
  kAnything,
  kNoSlice,  // nothing in the slice
  kInBand,   // ... and all usable and in the band
  kSurface,  // ... and of one surface
  kPassing,  // ... and all usable and outside the band
};

Content ContentOf(const Tile& tile, const SlopeBounds& slopes, const DepthRange& depth) {
  const ReturnLimits& limits = tile.limits;
  const float near = std::max(depth.least, limits.min_depth_m);  // of what is usable
  const float low = slopes.lowest.LeastOf(tile.rows), high = slopes.highest.MostOf(tile.rows);
  const float bottom = std::min(near * low, depth.most * low);
  const float top = std::max(near * high, depth.most * high);
  const auto outside = [&](float from_m, float to_m) { return top < from_m || bottom > to_m; };
  if (!tile.block.AreShared(tile.rows) || !outside(tile.slice.low_m, tile.slice.high_m))
    return Content::kAnything;
  if (depth.least < limits.min_depth_m) return Content::kNoSlice;
  if (outside(limits.low_m, limits.high_m)) return Content::kPassing;
  if (bottom < limits.low_m || top > limits.high_m) return Content::kNoSlice;
  // A little less, for what DepthBetween rounds.
  constexpr float kSurfaceShare = 0.999F * kSameSurfaceShare;
  const bool surface = depth.most - depth.least <= kSurfaceShare * depth.least;
  return surface ? Content::kSurface : Content::kInBand;
}

// How the two pixels around each lane's column are fetched.
enum class Fetch {
  kTwoVectors,  // from two vectors of neighbouring pixels
  kGather,      // from anywhere
};

struct Pixels {
  Vec z0, z1;
};

// Of two vectors laid side by side, the lanes `index`.
HWY_INLINE Vec LookUp(Floats d, Vec left, Vec right, hn::Vec<Ints> index) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(Floats()) == 16) {
    return Vec{_mm512_permutex2var_ps(left.raw, index.raw, right.raw)};
  }
#endif
  const Ints di;
  const auto lanes = hn::Set(di, static_cast<int>(hn::Lanes(d)));
  const auto within = hn::IndicesFromVec(d, hn::And(index, hn::Sub(lanes, hn::Set(di, 1))));
  return hn::IfThenElse(hn::RebindMask(d, hn::Lt(index, lanes)), hn::TableLookupLanes(left, within),
                        hn::TableLookupLanes(right, within));
}

// A whole number below 2^23 as an integer: its bits after adding 2^23, less those of 2^23.
HWY_INLINE hn::Vec<Ints> ToInt(Floats d, Vec whole) {
  constexpr float kTwoTo23 = 8388608.0F;
  constexpr int kBits = 0x4B000000;
  const Ints di;
  return hn::Sub(hn::BitCast(di, hn::Add(whole, hn::Set(d, kTwoTo23))), hn::Set(di, kBits));
}

// `column` are whole numbers from `start` on.
template <Fetch kFetch>
HWY_INLINE Pixels FetchPixels(Floats d, const float* HWY_RESTRICT row, int start, Vec column) {
  const Ints di;
  if constexpr (kFetch == Fetch::kGather) {
    const auto index = hn::ConvertTo(di, column);
    return {hn::GatherIndex(d, row, index), hn::GatherIndex(d, row + 1, index)};
  } else {
    const auto index = hn::Sub(ToInt(d, column), hn::Set(di, start));
    const Vec left = hn::LoadU(d, row + start), right = hn::LoadU(d, row + start + hn::Lanes(d));
    return {LookUp(d, left, right, index), LookUp(d, left, right, hn::Add(index, hn::Set(di, 1)))};
  }
}

// DepthBetween of bearing_returns.h.
template <bool kOneSurface>
HWY_INLINE Vec DepthBetweenLanes(Floats d, const Pixels& pixels, Vec share) {
  const auto [z0, z1] = pixels;
  const Vec difference = hn::Sub(z1, z0);
  const Vec between = hn::Add(z0, hn::Mul(share, difference));
  if constexpr (kOneSurface) return between;
  const Vec tolerance = hn::Mul(hn::Set(d, kSameSurfaceShare), hn::Min(z0, z1));
  const Mask same_surface = hn::Le(hn::Abs(difference), tolerance);
  if (HWY_LIKELY(hn::AllTrue(d, same_surface))) return between;
  const Vec nearer = hn::IfThenElse(hn::Lt(share, hn::Set(d, 0.5F)), z0, z1);
  const Vec apart = hn::IfThenElse(hn::Gt(nearer, hn::Zero(d)), nearer, hn::Max(z0, z1));
  return hn::IfThenElse(same_surface, between, apart);
}

// The samples of a tile that holds `kContent`.
template <Fetch kFetch, Content kContent>
HWY_NOINLINE void SampleTile(const Tile& tile, const SampleRows& out) {
  constexpr bool kSlice = kContent == Content::kAnything;
  constexpr bool kMixed = kContent == Content::kAnything || kContent == Content::kNoSlice;
  const Floats d;
  const BearingBlock& block = tile.block;
  const std::size_t i = tile.lane;
  const Vec u0 = hn::Load(d, &block.u0[i]), u1 = hn::Load(d, &block.u1[i]);
  const Vec h0 = hn::Load(d, &block.h0[i]), h1 = hn::Load(d, &block.h1[i]);
  const Vec g0 = hn::Load(d, &block.g0[i]), g1 = hn::Load(d, &block.g1[i]);
  const Vec first = hn::Load(d, &block.first[i]), last = hn::Load(d, &block.last[i]);
  const Vec min_depth = hn::Set(d, tile.limits.min_depth_m);
  const Vec low = hn::Set(d, tile.limits.low_m), high = hn::Set(d, tile.limits.high_m);
  const Vec slice_low = hn::Set(d, tile.slice.low_m), slice_high = hn::Set(d, tile.slice.high_m);
  const Vec passing = hn::Set(d, kPassing), unusable = hn::Set(d, kUnusable);
  const Vec max_column = hn::Set(d, LastColumn(tile.image.width_px));
  Vec nearest = unusable, slice_nearest = passing;
  Vec row = hn::Set(d, static_cast<float>(tile.rows.first));
  const float* HWY_RESTRICT pixels = tile.image.Row(tile.rows.first);
  float* HWY_RESTRICT samples = out.band.samples + tile.AtRow();
  float* HWY_RESTRICT slice = kSlice ? out.slice.samples + tile.AtRow() : nullptr;
  for (std::size_t r = 0; r < tile.RowCount(); ++r) {
    const Vec u = hn::Min(hn::Max(hn::Add(u0, hn::Mul(u1, row)), hn::Zero(d)), max_column);
    const Vec column = hn::Floor(u);
    const Pixels both = FetchPixels<kFetch>(d, pixels, tile.start, column);
    const Vec z = DepthBetweenLanes<kContent == Content::kSurface>(d, both, hn::Sub(u, column));
    const Vec range = hn::Mul(z, hn::Add(h0, hn::Mul(h1, row)));
    Vec sample = range;
    if constexpr (kMixed) {
      const Vec height = hn::Mul(z, hn::Add(g0, hn::Mul(g1, row)));
      const Mask marks = hn::And(hn::Ge(height, low), hn::Le(height, high));
      Mask usable = hn::Ge(z, min_depth);
      if constexpr (kSlice) {
        usable = hn::And(usable, hn::And(hn::Ge(row, first), hn::Le(row, last)));
        const Mask level = hn::And(hn::Ge(height, slice_low), hn::Le(height, slice_high));
        const Vec level_sample = hn::IfThenElse(hn::And(usable, level), range, passing);
        hn::Store(level_sample, d, slice);
        slice_nearest = hn::Min(slice_nearest, level_sample);
        slice += kBlockBearings;
      }
      sample = hn::IfThenElse(usable, hn::IfThenElse(marks, range, passing), unusable);
    }
    hn::Store(sample, d, samples);
    nearest = hn::Min(nearest, sample);
    row = hn::Add(row, hn::Set(d, 1.0F));
    pixels += tile.image.width_px;
    samples += kBlockBearings;
  }
  hn::Store(nearest, d, out.band.nearest + tile.AtGroup());
  hn::Store(slice_nearest, d, out.slice.nearest + tile.AtGroup());
}

template <Fetch kFetch>
void SampleTileAs(Content content, const Tile& tile, const SampleRows& out) {
  const Floats d;
  switch (content) {
    case Content::kAnything:
      return SampleTile<kFetch, Content::kAnything>(tile, out);
    case Content::kNoSlice:
      return SampleTile<kFetch, Content::kNoSlice>(tile, out);
    case Content::kInBand:
      return SampleTile<kFetch, Content::kInBand>(tile, out);
    case Content::kSurface:
      return SampleTile<kFetch, Content::kSurface>(tile, out);
    case Content::kPassing:  // nobody reads its samples
      hn::Store(hn::Set(d, kPassing), d, out.band.nearest + tile.AtGroup());
      hn::Store(hn::Set(d, kPassing), d, out.slice.nearest + tile.AtGroup());
  }
}

void SampleOneTile(Tile& tile, const SlopeBounds& slopes, const SampleRows& out) {
  const Floats d;
  FindColumns(tile);
  const DepthRange depth = SurveyDepth(tile);
  hn::Store(hn::Set(d, depth.least), d, out.band.least_depth + tile.AtGroup());
  const Content content = ContentOf(tile, slopes, depth);
  if (tile.columns > 0 && tile.columns <= static_cast<int>(2 * hn::Lanes(d))) {
    SampleTileAs<Fetch::kTwoVectors>(content, tile, out);
  } else {
    SampleTileAs<Fetch::kGather>(content, tile, out);
  }
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

void SampleAll(const DepthImage& image, const ReturnLimits& limits, const SliceBand& slice,
               const BearingBlock& block, const SampleRows& out, BlockSamples& found) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::array<SlopeBounds, kBlockBearings> slopes;
  for (std::size_t lane = 0; lane < kBlockBearings; lane += lanes) {
    slopes[lane / lanes] = BoundSlopes(block, lane);
  }
  for (std::size_t group = 0; group < block.GroupCount(); ++group) {
    for (std::size_t lane = 0; lane < kBlockBearings; lane += lanes) {
      Tile tile{image, limits, slice, block, lane, block.RowsOfGroup(group)};
      SampleOneTile(tile, slopes[lane / lanes], out);
    }
  }
  SmallestOfGroups(out.band.least_depth, block.GroupCount(), found.least_depth);
  SmallestOfGroups(out.band.nearest, block.GroupCount(), found.nearest);
  SmallestOfGroups(out.slice.nearest, block.GroupCount(), found.slice_nearest);
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SampleAll);

BlockSamples SampleBlock(const DepthImage& image, const ReturnLimits& limits,
                         const SliceBand& slice, const BearingBlock& block,
                         const SampleRows& rows) {
  BlockSamples found;
  HWY_DYNAMIC_DISPATCH(SampleAll)(image, limits, slice, block, rows, found);
  return found;
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
