#include "mapper/scan/bearing_block.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

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

// Rows worked on before the next bearings: their pixels and the lanes' constants stay in the
// first-level cache and in registers.
constexpr std::size_t kChunkRows = 32;

// How the two pixels around each lane's column are fetched.
enum class Fetch {
  kOneVector,   // the columns of neighbouring lanes lie within one vector of pixels
  kTwoVectors,  // ... within two
  kGather,      // anywhere
};

struct Pixels {
  Vec z0, z1;
};

// A whole number below 2^23 as an integer: its bits after adding 2^23, less those of 2^23 (which
// lane indices need not, as only their low bits count).
HWY_INLINE hn::Vec<Ints> BitsOf(Floats d, Vec whole) {
  constexpr float kTwoTo23 = 8388608.0F;
  return hn::BitCast(Ints(), hn::Add(whole, hn::Set(d, kTwoTo23)));
}

// `column` are whole numbers; `start` the first one any lane can have, and `start_f` the same.
template <Fetch kFetch>
HWY_INLINE Pixels FetchPixels(Floats d, const float* HWY_RESTRICT row, int start, float start_f,
                              Vec column) {
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  if constexpr (kFetch == Fetch::kGather) {
    const auto index = hn::ConvertTo(di, column);
    return {hn::GatherIndex(d, row, index), hn::GatherIndex(d, row + 1, index)};
  } else {
    const Vec offset = hn::Sub(column, hn::Set(d, start_f));
    const auto indices = hn::IndicesFromVec(d, hn::And(BitsOf(d, offset), hn::Set(di, lanes - 1)));
    const auto lookup = [&](int at) HWY_ATTR {
      return hn::TableLookupLanes(hn::LoadU(d, row + start + at), indices);
    };
    if constexpr (kFetch == Fetch::kOneVector) return {lookup(0), lookup(1)};
    const Mask second = hn::Ge(offset, hn::Set(d, static_cast<float>(lanes)));
    return {hn::IfThenElse(second, lookup(lanes), lookup(0)),
            hn::IfThenElse(second, lookup(lanes + 1), lookup(1))};
  }
}

// Linear in the row.
struct SlopeBound {
  float at_0 = 0.0F, per_row = 0.0F;
  float At(int row) const { return at_0 + per_row * static_cast<float>(row); }
};

// No ray of a strip rises less or more a depth, rounding included.
struct SlopeBounds {
  SlopeBound lowest, highest;
};

// A strip: the lanes of one vector, from lane `lane` of the block on, and a chunk of rows.
struct Strip {
  const DepthImage& image;
  const ReturnLimits& limits;
  const std::optional<SliceBand>& slice;
  const BearingBlock& block;
  std::size_t lane;
  const SlopeBounds& slopes;
  RowRange rows;
  // First column any lane needs in each row.
  HWY_ALIGN std::array<int, kChunkRows> start;
  HWY_ALIGN std::array<float, kChunkRows> start_f;
};

// What lies in a group of rows: of the nearest and the farthest depth and the outer rays.
enum class Content : std::uint8_t {
  kAnything,
  kNoSlice,  // nothing in the slice
  kInBand,   // ... and all usable and in the band
  kPassing,  // ... and all usable and outside the band
};

// DepthBetween of bearing_returns.h.
HWY_INLINE Vec DepthBetweenLanes(Floats d, const Pixels& pixels, Vec share) {
  const auto [z0, z1] = pixels;
  const Vec difference = hn::Sub(z1, z0);
  const Vec tolerance = hn::Mul(hn::Set(d, kSameSurfaceShare), hn::Min(z0, z1));
  const Mask same_surface = hn::Le(hn::Abs(difference), tolerance);
  const Vec between = hn::Add(z0, hn::Mul(share, difference));
  if (HWY_LIKELY(hn::AllTrue(d, same_surface))) return between;
  const Vec nearer = hn::IfThenElse(hn::Lt(share, hn::Set(d, 0.5F)), z0, z1);
  const Vec apart = hn::IfThenElse(hn::Gt(nearer, hn::Zero(d)), nearer, hn::Max(z0, z1));
  return hn::IfThenElse(same_surface, between, apart);
}

// Rows of a strip, and where their group begins in the block.
struct Group {
  RowRange rows;
  bool all_rows;  // every lane takes part in all of them
  std::size_t at_row, at_group;
};

HWY_INLINE Content ContentOf(Floats d, const Strip& strip, const Group& group, Vec z_min,
                             Vec z_max) {
  const Vec min_depth = hn::Set(d, strip.limits.min_depth_m);
  const bool usable = group.all_rows && hn::AllTrue(d, hn::Ge(z_min, min_depth));
  const Vec near = hn::Max(z_min, min_depth);  // of what is usable
  const auto [lowest, highest] = strip.slopes;
  const auto [first, last] = group.rows;
  const Vec low = hn::Set(d, std::min(lowest.At(first), lowest.At(last)));
  const Vec high = hn::Set(d, std::max(highest.At(first), highest.At(last)));
  const Vec bottom = hn::Min(hn::Mul(near, low), hn::Mul(z_max, low));
  const Vec top = hn::Max(hn::Mul(near, high), hn::Mul(z_max, high));
  const auto outside = [&](float from_m, float to_m) HWY_ATTR {
    return hn::AllTrue(d,
                       hn::Or(hn::Lt(top, hn::Set(d, from_m)), hn::Gt(bottom, hn::Set(d, to_m))));
  };
  if (strip.slice && !outside(strip.slice->low_m, strip.slice->high_m)) return Content::kAnything;
  if (!usable) return Content::kNoSlice;
  if (outside(strip.limits.low_m, strip.limits.high_m)) return Content::kPassing;
  const bool in_band = hn::AllTrue(d, hn::And(hn::Ge(bottom, hn::Set(d, strip.limits.low_m)),
                                              hn::Le(top, hn::Set(d, strip.limits.high_m))));
  return in_band ? Content::kInBand : Content::kNoSlice;
}

// The samples of a group that holds what `kContent` says; right only if it does. Returns what it
// does hold.
template <Fetch kFetch, bool kAllRows, Content kContent>
HWY_NOINLINE Content SampleGroup(const Strip& strip, const Group& group, const SampleRows& out) {
  constexpr bool kSlice = kContent == Content::kAnything;
  constexpr bool kMixed = kContent == Content::kAnything || kContent == Content::kNoSlice;
  const Floats d;
  const BearingBlock& block = strip.block;
  const std::size_t i = strip.lane;
  const auto width = static_cast<std::size_t>(strip.image.width_px);
  const Vec u0 = hn::Load(d, &block.u0[i]), u1 = hn::Load(d, &block.u1[i]);
  const Vec h0 = hn::Load(d, &block.h0[i]), h1 = hn::Load(d, &block.h1[i]);
  const Vec g0 = hn::Load(d, &block.g0[i]), g1 = hn::Load(d, &block.g1[i]);
  const Vec min_depth = hn::Set(d, strip.limits.min_depth_m);
  const Vec low = hn::Set(d, strip.limits.low_m), high = hn::Set(d, strip.limits.high_m);
  const Vec passing = hn::Set(d, kPassing), unusable = hn::Set(d, kUnusable);
  const Vec max_column = hn::Set(d, LastColumn(strip.image.width_px));
  const SliceBand& level_band = kSlice ? *strip.slice : SliceBand{};
  const Vec slice_low = hn::Set(d, level_band.low_m), slice_high = hn::Set(d, level_band.high_m);
  Vec nearest = unusable, slice_nearest = passing, z_min = unusable, z_max = hn::Zero(d);
  Vec row = hn::Set(d, static_cast<float>(group.rows.first));
  const float* HWY_RESTRICT pixels = strip.image.Row(group.rows.first);
  float* HWY_RESTRICT samples = out.band.samples + group.at_row + i;
  float* HWY_RESTRICT slice = kSlice ? out.slice.samples + group.at_row + i : nullptr;
  const bool has_next = group.rows.last + static_cast<int>(kChunkRows) < strip.image.height_px;
  const std::size_t ahead = has_next ? kChunkRows * width : 0;
  const auto begin = static_cast<std::size_t>(group.rows.first - strip.rows.first);
  const auto end = static_cast<std::size_t>(group.rows.last - strip.rows.first + 1);
  for (std::size_t r = begin; r < end; ++r) {
    const Vec u = hn::Min(hn::Max(hn::Add(u0, hn::Mul(u1, row)), hn::Zero(d)), max_column);
    const Vec column = hn::Floor(u);
    const Pixels both = FetchPixels<kFetch>(d, pixels, strip.start[r], strip.start_f[r], column);
    const Vec z = DepthBetweenLanes(d, both, hn::Sub(u, column));
    Vec sample = passing;
    if constexpr (kContent != Content::kPassing) {
      sample = hn::Mul(z, hn::Add(h0, hn::Mul(h1, row)));
    }
    Mask inside;
    if constexpr (!kAllRows) {
      inside = hn::And(hn::Ge(row, hn::Load(d, &block.first[i])),
                       hn::Le(row, hn::Load(d, &block.last[i])));
    }
    if constexpr (kMixed) {
      const Vec range = sample;
      const Vec height = hn::Mul(z, hn::Add(g0, hn::Mul(g1, row)));
      const Mask marks = hn::And(hn::Ge(height, low), hn::Le(height, high));
      Mask usable = hn::Ge(z, min_depth);
      if constexpr (!kAllRows) usable = hn::And(usable, inside);
      sample = hn::IfThenElse(usable, hn::IfThenElse(marks, range, passing), unusable);
      if constexpr (kSlice) {
        const Mask level = hn::And(hn::Ge(height, slice_low), hn::Le(height, slice_high));
        const Vec level_sample = hn::IfThenElse(hn::And(usable, level), range, passing);
        hn::Store(level_sample, d, slice);
        slice_nearest = hn::Min(slice_nearest, level_sample);
        slice += kBlockBearings;
      }
    }
    hn::Store(sample, d, samples);
    if constexpr (kContent != Content::kPassing) nearest = hn::Min(nearest, sample);
    z_min = hn::Min(z_min, kAllRows ? z : hn::IfThenElse(inside, z, unusable));
    z_max = hn::Max(z_max, kAllRows ? z : hn::IfThenElseZero(inside, z));
    // The next chunk of rows; the processor does not foresee steps of a whole image row.
    hwy::Prefetch(pixels + ahead + strip.start[r]);
    row = hn::Add(row, hn::Set(d, 1.0F));
    pixels += width;
    samples += kBlockBearings;
  }
  if constexpr (kContent == Content::kPassing) nearest = passing;
  hn::Store(nearest, d, out.band.nearest + group.at_group + i);
  hn::Store(z_min, d, out.band.least_depth + group.at_group + i);
  if constexpr (kSlice) hn::Store(slice_nearest, d, out.slice.nearest + group.at_group + i);
  return ContentOf(d, strip, group, z_min, z_max);
}

// Columns are monotonic in the bearing while all rays look ahead, so the outer lanes bound them.
Fetch FetchFor(const Strip& strip) {
  const std::size_t lanes = hn::Lanes(Floats());
  const BearingBlock& block = strip.block;
  const std::size_t a = strip.lane, b = strip.lane + lanes - 1;
  if (strip.image.width_px < static_cast<int>(2 * lanes + 2) || !block.all_ahead) {
    return Fetch::kGather;
  }
  float span = 0.0F;
  for (const int v : {strip.rows.first, strip.rows.last}) {
    const auto row = static_cast<float>(v);
    span = std::max(
        span, std::abs((block.u0[a] + block.u1[a] * row) - (block.u0[b] + block.u1[b] * row)));
  }
  // A column and its floor, the second pixel, and rounding.
  constexpr float kMargin = 1.01F;
  if (span + kMargin < static_cast<float>(lanes)) return Fetch::kOneVector;
  return span + kMargin < static_cast<float>(2 * lanes) ? Fetch::kTwoVectors : Fetch::kGather;
}

void FindStarts(Fetch fetch, Strip& strip) {
  const hn::CappedTag<float, kChunkRows> d;
  const BearingBlock& block = strip.block;
  const std::size_t lanes = hn::Lanes(Floats());
  const std::size_t a = strip.lane, b = strip.lane + lanes - 1;
  // The loads end one pixel after the last vector.
  const int loaded = static_cast<int>(fetch == Fetch::kOneVector ? lanes : 2 * lanes) + 1;
  const auto max_start = static_cast<float>(strip.image.width_px - loaded);
  for (std::size_t r = 0; r < kChunkRows; r += hn::Lanes(d)) {
    const auto row = hn::Add(hn::Set(d, static_cast<float>(strip.rows.first)),
                             hn::Iota(d, static_cast<float>(r)));
    const auto column = [&](std::size_t k) HWY_ATTR {
      return hn::Add(hn::Set(d, block.u0[k]), hn::Mul(hn::Set(d, block.u1[k]), row));
    };
    const auto leftmost = hn::Floor(hn::Min(column(a), column(b)));
    const auto start = hn::Max(hn::Min(leftmost, hn::Set(d, max_start)), hn::Zero(d));
    hn::Store(start, d, &strip.start_f[r]);
    hn::Store(hn::ConvertTo(hn::RebindToSigned<decltype(d)>(), start),
              hn::RebindToSigned<decltype(d)>(), &strip.start[r]);
  }
}

template <Fetch kFetch>
Content SampleGroupAs(Content content, const Strip& strip, const Group& group,
                      const SampleRows& out) {
  if (!group.all_rows) {
    return content == Content::kAnything
               ? SampleGroup<kFetch, false, Content::kAnything>(strip, group, out)
               : SampleGroup<kFetch, false, Content::kNoSlice>(strip, group, out);
  }
  switch (content) {
    case Content::kPassing:
      return SampleGroup<kFetch, true, Content::kPassing>(strip, group, out);
    case Content::kInBand:
      return SampleGroup<kFetch, true, Content::kInBand>(strip, group, out);
    case Content::kNoSlice:
      return SampleGroup<kFetch, true, Content::kNoSlice>(strip, group, out);
    case Content::kAnything:
      break;
  }
  return SampleGroup<kFetch, true, Content::kAnything>(strip, group, out);
}

// Each group is taken for what the one before held; where that is wrong it is done again.
template <Fetch kFetch>
Content SampleStrip(Content content, const Strip& strip, const SampleRows& out) {
  const RowRange& shared = strip.block.shared_rows;
  constexpr int kStep = static_cast<int>(kGroupRows);
  for (int first = strip.rows.first; first <= strip.rows.last; first += kStep) {
    const RowRange rows{first, std::min(first + kStep - 1, strip.rows.last)};
    const auto row = static_cast<std::size_t>(first - strip.block.rows.first);
    const Group group{rows, rows.first >= shared.first && rows.last <= shared.last,
                      row * kBlockBearings, row / kGroupRows * kBlockBearings};
    const Content taken_for = content;
    content = SampleGroupAs<kFetch>(taken_for, strip, group, out);
    const bool right = taken_for == content || taken_for == Content::kAnything ||
                       (taken_for == Content::kNoSlice && content != Content::kAnything);
    if (!right) SampleGroupAs<kFetch>(content, strip, group, out);
  }
  return content;
}

Content SampleChunk(Content content, Strip& strip, const SampleRows& out) {
  const Fetch fetch = FetchFor(strip);
  FindStarts(fetch, strip);
  switch (fetch) {
    case Fetch::kOneVector:
      return SampleStrip<Fetch::kOneVector>(content, strip, out);
    case Fetch::kTwoVectors:
      return SampleStrip<Fetch::kTwoVectors>(content, strip, out);
    case Fetch::kGather:
      break;
  }
  return SampleStrip<Fetch::kGather>(content, strip, out);
}

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

void SampleAll(const DepthImage& image, const ReturnLimits& limits,
               const std::optional<SliceBand>& slice, const BearingBlock& block,
               const SampleRows& out, BlockSamples& found) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  constexpr int kStep = static_cast<int>(kChunkRows);
  std::array<SlopeBounds, kBlockBearings> slopes;
  std::array<Content, kBlockBearings> contents;
  contents.fill(slice ? Content::kAnything : Content::kNoSlice);
  for (std::size_t lane = 0; lane < kBlockBearings; lane += lanes) {
    slopes[lane / lanes] = BoundSlopes(block, lane);
  }
  for (int first = block.rows.first; first <= block.rows.last; first += kStep) {
    const RowRange rows{first, std::min(first + kStep - 1, block.rows.last)};
    for (std::size_t lane = 0; lane < kBlockBearings; lane += lanes) {
      Strip strip{image, limits, slice, block, lane, slopes[lane / lanes], rows, {}, {}};
      Content& content = contents[lane / lanes];
      content = SampleChunk(content, strip, out);
    }
  }
  SmallestOfGroups(out.band.least_depth, block.GroupCount(), found.least_depth);
  SmallestOfGroups(out.band.nearest, block.GroupCount(), found.nearest);
  if (slice) {
    SmallestOfGroups(out.slice.nearest, block.GroupCount(), found.slice_nearest);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SampleAll);

BlockSamples SampleBlock(const DepthImage& image, const ReturnLimits& limits,
                         const std::optional<SliceBand>& slice, const BearingBlock& block,
                         const SampleRows& rows) {
  BlockSamples found;
  if (slice) std::fill_n(rows.slice.nearest, block.GroupCount() * kBlockBearings, kPassing);
  HWY_DYNAMIC_DISPATCH(SampleAll)
  (image, limits, slice, block, rows, found);
  return found;
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
