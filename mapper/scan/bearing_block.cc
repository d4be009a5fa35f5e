#include "mapper/scan/bearing_block.h"

#include <algorithm>
#include <cmath>

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

// A strip: the lanes of one vector, from lane `lane` of the block on, and a chunk of rows.
struct Strip {
  const DepthImage& image;
  const ReturnLimits& limits;
  const SliceBand& slice;
  const BearingBlock& block;
  std::size_t lane;
  RowRange rows;
  // First column any lane needs in each row.
  HWY_ALIGN std::array<int, kChunkRows> start;
  HWY_ALIGN std::array<float, kChunkRows> start_f;
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

template <Fetch kFetch, bool kAllRows, bool kSlice>
HWY_NOINLINE void SampleStrip(const Strip& strip, const SampleRows& out, BlockSamples& found) {
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
  Vec nearest = hn::Load(d, &found.nearest[i]);
  Vec farthest = hn::Load(d, &found.farthest[i]);
  Vec row = hn::Set(d, static_cast<float>(strip.rows.first));
  const float* HWY_RESTRICT pixels = strip.image.Row(strip.rows.first);
  const std::size_t at =
      static_cast<std::size_t>(strip.rows.first - block.rows.first) * kBlockBearings + i;
  float* HWY_RESTRICT samples = out.samples + at;
  float* HWY_RESTRICT slice = kSlice ? out.slice + at : nullptr;
  const Vec slice_low = hn::Set(d, strip.slice.low_m), slice_high = hn::Set(d, strip.slice.high_m);
  Vec slice_nearest = hn::Load(d, &found.slice_nearest[i]);
  const std::size_t ahead = strip.rows.last + static_cast<int>(kChunkRows) < strip.image.height_px
                                ? kChunkRows * width
                                : 0;
  const auto count = static_cast<std::size_t>(strip.rows.last - strip.rows.first + 1);
  for (std::size_t r = 0; r < count; ++r) {
    const Vec u = hn::Min(hn::Max(hn::Add(u0, hn::Mul(u1, row)), hn::Zero(d)), max_column);
    const Vec column = hn::Floor(u);
    const Pixels both = FetchPixels<kFetch>(d, pixels, strip.start[r], strip.start_f[r], column);
    const Vec z = DepthBetweenLanes(d, both, hn::Sub(u, column));
    const Vec range = hn::Mul(z, hn::Add(h0, hn::Mul(h1, row)));
    const Vec height = hn::Mul(z, hn::Add(g0, hn::Mul(g1, row)));
    const Mask marks = hn::And(hn::Ge(height, low), hn::Le(height, high));
    Mask usable = hn::Ge(z, min_depth);
    if constexpr (!kAllRows) {
      usable = hn::And(usable, hn::And(hn::Ge(row, hn::Load(d, &block.first[i])),
                                       hn::Le(row, hn::Load(d, &block.last[i]))));
    }
    const Vec sample = hn::IfThenElse(usable, hn::IfThenElse(marks, range, passing), unusable);
    hn::Store(sample, d, samples);
    nearest = hn::Min(nearest, sample);
    farthest = hn::Max(farthest, sample);
    if constexpr (kSlice) {
      const Mask level = hn::And(hn::Ge(height, slice_low), hn::Le(height, slice_high));
      const Vec level_sample = hn::IfThenElse(hn::And(usable, level), range, passing);
      hn::Store(level_sample, d, slice);
      slice_nearest = hn::Min(slice_nearest, level_sample);
      slice += kBlockBearings;
    }
    // The next chunk of rows; the processor does not foresee steps of a whole image row.
    hwy::Prefetch(pixels + ahead + strip.start[r]);
    row = hn::Add(row, hn::Set(d, 1.0F));
    pixels += width;
    samples += kBlockBearings;
  }
  hn::Store(nearest, d, &found.nearest[i]);
  hn::Store(farthest, d, &found.farthest[i]);
  if constexpr (kSlice) hn::Store(slice_nearest, d, &found.slice_nearest[i]);
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
void SampleStripBy(const Strip& strip, const SampleRows& out, BlockSamples& found) {
  const RowRange& shared = strip.block.shared_rows;
  const RowRange& slice = strip.block.slice_rows;
  const bool all_rows = strip.rows.first >= shared.first && strip.rows.last <= shared.last;
  const bool sliced = strip.rows.first <= slice.last && strip.rows.last >= slice.first;
  if (sliced) {
    return all_rows ? SampleStrip<kFetch, true, true>(strip, out, found)
                    : SampleStrip<kFetch, false, true>(strip, out, found);
  }
  return all_rows ? SampleStrip<kFetch, true, false>(strip, out, found)
                  : SampleStrip<kFetch, false, false>(strip, out, found);
}

void SampleChunk(Strip& strip, const SampleRows& out, BlockSamples& found) {
  const Fetch fetch = FetchFor(strip);
  FindStarts(fetch, strip);
  switch (fetch) {
    case Fetch::kOneVector:
      return SampleStripBy<Fetch::kOneVector>(strip, out, found);
    case Fetch::kTwoVectors:
      return SampleStripBy<Fetch::kTwoVectors>(strip, out, found);
    case Fetch::kGather:
      return SampleStripBy<Fetch::kGather>(strip, out, found);
  }
}

void SampleAll(const DepthImage& image, const ReturnLimits& limits, const SliceBand& slice,
               const BearingBlock& block, const SampleRows& out, BlockSamples& found) {
  const std::size_t lanes = hn::Lanes(Floats());
  constexpr int kStep = static_cast<int>(kChunkRows);
  for (int first = block.rows.first; first <= block.rows.last; first += kStep) {
    const RowRange rows{first, std::min(first + kStep - 1, block.rows.last)};
    for (std::size_t lane = 0; lane < kBlockBearings; lane += lanes) {
      Strip strip{image, limits, slice, block, lane, rows, {}, {}};
      SampleChunk(strip, out, found);
    }
  }
}

// Sum and number of a lane's samples in [from, to].
struct Running {
  Vec from, to, sum, count;

  HWY_INLINE void Add(Floats d, Vec sample) {
    const Mask inside = hn::And(hn::Ge(sample, from), hn::Le(sample, to));
    sum = hn::Add(sum, hn::IfThenElseZero(inside, sample));
    count = hn::Add(count, hn::IfThenElseZero(inside, hn::Set(d, 1.0F)));
  }
};

void MeanLanes(const float* HWY_RESTRICT samples, std::size_t rows, const BlockLane& low,
               const BlockLane& high, const BlockLane& otherwise, BlockMean& out) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const auto start = [&](std::size_t i) HWY_ATTR {
    return Running{hn::Load(d, &low[i]), hn::Load(d, &high[i]), hn::Zero(d), hn::Zero(d)};
  };
  const auto finish = [&](const Running& running, std::size_t i) HWY_ATTR {
    const Mask any = hn::Gt(running.count, hn::Zero(d));
    const Vec mean = hn::Div(running.sum, hn::Max(running.count, hn::Set(d, 1.0F)));
    hn::Store(hn::IfThenElse(any, mean, hn::Load(d, &otherwise[i])), d, &out.mean[i]);
    hn::Store(running.count, d, &out.count[i]);
  };
  // Two vectors at a time: the additions of one wait for each other, those of the other fill in.
  static_assert(kBlockBearings % (2 * hn::MaxLanes(Floats())) == 0);
  for (std::size_t i = 0; i < kBlockBearings; i += 2 * lanes) {
    Running a = start(i), b = start(i + lanes);
    for (std::size_t r = 0; r < rows; ++r) {
      const float* HWY_RESTRICT row = samples + r * kBlockBearings + i;
      a.Add(d, hn::Load(d, row));
      b.Add(d, hn::Load(d, row + lanes));
    }
    finish(a, i);
    finish(b, i + lanes);
  }
}

// The longest run between two usable rows so far.
struct Gap {
  Vec from, to;
};
HWY_INLINE Gap Longer(Mask here, Vec from, Vec to, const Gap& gap) {
  const Mask longer = hn::And(here, hn::Gt(hn::Sub(to, from), hn::Sub(gap.to, gap.from)));
  return {hn::IfThenElse(longer, from, gap.from), hn::IfThenElse(longer, to, gap.to)};
}

// Lanes of which every row was usable.
void SeeAll(const BearingBlock& block, std::size_t i, BlockViews& out) {
  const Floats d;
  const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  hn::Store(hn::Set(d, static_cast<float>(block.rows.first)), d, &out.first[i]);
  hn::Store(hn::Set(d, static_cast<float>(block.rows.last)), d, &out.last[i]);
  for (BlockLane* from : {&out.below_from, &out.above_from}) hn::Store(zero, d, &(*from)[i]);
  for (BlockLane* to : {&out.below_to, &out.above_to}) hn::Store(one, d, &(*to)[i]);
}

void ViewLanes(const BearingBlock& block, const BlockLane& farthest,
               const float* HWY_RESTRICT samples, BlockViews& out) {
  const Floats d;
  const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    if (hn::AllTrue(d, hn::Lt(hn::Load(d, &farthest[i]), hn::Set(d, kUnusable)))) {
      SeeAll(block, i, out);
      continue;
    }
    const Vec g0 = hn::Load(d, &block.g0[i]), g1 = hn::Load(d, &block.g1[i]);
    Vec first = zero, last = hn::Set(d, -1.0F);
    // A run needs a row between: the difference of its ends exceeds one.
    Gap below{zero, one}, above{zero, one};
    Vec row = hn::Set(d, static_cast<float>(block.rows.first));
    bool all_before = false;  // every lane was usable in the row before
    for (std::size_t r = 0; r < block.RowCount(); ++r) {
      const Vec sample = hn::Load(d, samples + r * kBlockBearings + i);
      const Mask usable = hn::Lt(sample, hn::Set(d, kUnusable));
      const bool all = hn::AllTrue(d, usable);
      if (HWY_UNLIKELY(!all || !all_before)) {
        const Mask started = hn::Ge(last, zero);
        const Mask ends_gap = hn::And(usable, started);
        const Mask high = hn::Gt(hn::Add(g0, hn::Mul(g1, row)), zero);
        above = Longer(hn::And(ends_gap, high), last, row, above);
        below = Longer(hn::AndNot(high, ends_gap), last, row, below);
        first = hn::IfThenElse(hn::AndNot(started, usable), row, first);
      }
      last = hn::IfThenElse(usable, row, last);
      all_before = all;
      row = hn::Add(row, one);
    }
    hn::Store(first, d, &out.first[i]);
    hn::Store(last, d, &out.last[i]);
    hn::Store(below.from, d, &out.below_from[i]);
    hn::Store(below.to, d, &out.below_to[i]);
    hn::Store(above.from, d, &out.above_from[i]);
    hn::Store(above.to, d, &out.above_to[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SampleAll);
HWY_EXPORT(MeanLanes);
HWY_EXPORT(ViewLanes);

BlockSamples SampleBlock(const DepthImage& image, const ReturnLimits& limits,
                         const std::optional<SliceBand>& slice, const BearingBlock& block,
                         const SampleRows& rows) {
  BlockSamples found;
  found.nearest.fill(kUnusable);
  found.farthest.fill(0.0F);
  found.slice_nearest.fill(kPassing);
  HWY_DYNAMIC_DISPATCH(SampleAll)
  (image, limits, slice.value_or(SliceBand{}), block, rows, found);
  return found;
}

BlockMean MeanWithin(const float* samples, std::size_t rows, const BlockLane& low,
                     const BlockLane& high, const BlockLane& otherwise) {
  BlockMean mean;
  HWY_DYNAMIC_DISPATCH(MeanLanes)(samples, rows, low, high, otherwise, mean);
  return mean;
}

BlockViews FindViews(const BearingBlock& block, const BlockLane& farthest, const float* samples) {
  BlockViews views;
  HWY_DYNAMIC_DISPATCH(ViewLanes)(block, farthest, samples, views);
  return views;
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
