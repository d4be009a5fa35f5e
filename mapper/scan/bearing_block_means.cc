// Means and views of the samples a block left (bearing_block.h).
#include "mapper/scan/bearing_block.h"

// x86-64-v3 has AVX2 without AES, which nothing here needs.
#define HWY_DISABLE_PCLMUL_AES
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_block_means.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBlockBearings>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

// Sum and number of a lane's samples in [from, to], or of all up to `to`.
template <bool kFromLeast>
struct Running {
  Vec from, to, sum, count;

  HWY_INLINE void Add(Floats d, Vec sample) {
#if HWY_TARGET <= HWY_AVX3
    if constexpr (hn::MaxLanes(Floats()) == 16) {  // masks are half of the operations otherwise
      const __mmask16 near = _mm512_cmp_ps_mask(sample.raw, to.raw, _CMP_LE_OQ);
      const __mmask16 inside =
          kFromLeast ? near : _mm512_mask_cmp_ps_mask(near, sample.raw, from.raw, _CMP_GE_OQ);
      sum = Vec{_mm512_mask_add_ps(sum.raw, inside, sum.raw, sample.raw)};
      count = Vec{_mm512_mask_add_ps(count.raw, inside, count.raw, hn::Set(d, 1.0F).raw)};
      return;
    }
#endif
    Mask inside = hn::Le(sample, to);
    if constexpr (!kFromLeast) inside = hn::And(inside, hn::Ge(sample, from));
    sum = hn::Add(sum, hn::IfThenElseZero(inside, sample));
    count = hn::Add(count, hn::IfThenElseZero(inside, hn::Set(d, 1.0F)));
  }
};

template <bool kFromLeast>
void MeanOf(const BandSamples& band, std::size_t rows, const BlockLane& low, const BlockLane& high,
            const BlockLane& otherwise, BlockMean& out) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const auto start = [&](std::size_t i) HWY_ATTR {
    return Running<kFromLeast>{hn::Load(d, &low[i]), hn::Load(d, &high[i]), hn::Zero(d),
                               hn::Zero(d)};
  };
  const auto finish = [&](const Running<kFromLeast>& running, std::size_t i) HWY_ATTR {
    const Mask any = hn::Gt(running.count, hn::Zero(d));
    const Vec mean = hn::Div(running.sum, hn::Max(running.count, hn::Set(d, 1.0F)));
    hn::Store(hn::IfThenElse(any, mean, hn::Load(d, &otherwise[i])), d, &out.mean[i]);
    hn::Store(running.count, d, &out.count[i]);
  };
  static_assert(kBlockBearings % (2 * hn::MaxLanes(Floats())) == 0);
  for (std::size_t i = 0; i < kBlockBearings; i += 2 * lanes) {
    Running<kFromLeast> a = start(i), b = start(i + lanes);
    for (std::size_t first = 0; first < rows; first += kGroupRows) {
      const float* HWY_RESTRICT nearest = band.nearest + first / kGroupRows * kBlockBearings + i;
      const bool near_a = !hn::AllFalse(d, hn::Le(hn::Load(d, nearest), a.to));
      const bool near_b = !hn::AllFalse(d, hn::Le(hn::Load(d, nearest + lanes), b.to));
      if (!near_a && !near_b) continue;
      const float* HWY_RESTRICT row = band.samples + first * kBlockBearings + i;
      const float* const end = row + std::min(kGroupRows, rows - first) * kBlockBearings;
      if (near_a && near_b) {
        // The additions of one wait for each other, those of the other fill in.
        for (; row != end; row += kBlockBearings) {
          a.Add(d, hn::Load(d, row));
          b.Add(d, hn::Load(d, row + lanes));
        }
      } else if (near_a) {
        for (; row != end; row += kBlockBearings) a.Add(d, hn::Load(d, row));
      } else {
        for (; row != end; row += kBlockBearings) b.Add(d, hn::Load(d, row + lanes));
      }
    }
    finish(a, i);
    finish(b, i + lanes);
  }
}

void MeanLanes(const BandSamples& band, std::size_t rows, const BlockLane& low,
               const BlockLane& high, const BlockLane& otherwise, BlockMean& out) {
  MeanOf<false>(band, rows, low, high, otherwise, out);
}

void MeanLanesUpTo(const BandSamples& band, std::size_t rows, const BlockLane& high,
                   const BlockLane& otherwise, BlockMean& out) {
  MeanOf<true>(band, rows, high, high, otherwise, out);
}

// The longest run between two usable rows so far.
struct Gap {
  Vec from, to;
};
HWY_INLINE Gap Longer(Mask here, Vec from, Vec to, const Gap& gap) {
  const Mask longer = hn::And(here, hn::Gt(hn::Sub(to, from), hn::Sub(gap.to, gap.from)));
  return {hn::IfThenElse(longer, from, gap.from), hn::IfThenElse(longer, to, gap.to)};
}

// Stands for the last usable row before there is one: the run to the first is longer than any.
constexpr float kNeverSeen = -1e6F;

// Lanes of which every row was usable.
void SeeAll(const BearingBlock& block, std::size_t i, BlockViews& out) {
  const Floats d;
  const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  hn::Store(hn::Load(d, &block.first[i]), d, &out.first[i]);
  hn::Store(hn::Load(d, &block.last[i]), d, &out.last[i]);
  for (BlockLane* from : {&out.below_from, &out.above_from}) hn::Store(zero, d, &(*from)[i]);
  for (BlockLane* to : {&out.below_to, &out.above_to}) hn::Store(one, d, &(*to)[i]);
}

void ViewLanes(const BearingBlock& block, const BlockLane& least_depth, const BandSamples& band,
               float min_depth_m, BlockViews& out) {
  const Floats d;
  const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0F), min_depth = hn::Set(d, min_depth_m);
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    if (hn::AllTrue(d, hn::Ge(hn::Load(d, &least_depth[i]), min_depth))) {
      SeeAll(block, i, out);
      continue;
    }
    const Vec g0 = hn::Load(d, &block.g0[i]), g1 = hn::Load(d, &block.g1[i]);
    Vec first = zero, last = hn::Set(d, kNeverSeen);
    // A run needs a row between: the difference of its ends exceeds one.
    Gap below{zero, one}, above{zero, one};
    // Runs up to this long change nothing; the first usable row is looked at too.
    Vec long_above = one, long_below = one;
    const auto take = [&](int v, Mask usable) HWY_ATTR {
      const Vec row = hn::Set(d, static_cast<float>(v));
      const Mask high = hn::Gt(hn::Add(g0, hn::Mul(g1, row)), zero);
      const Vec noticed = hn::IfThenElse(high, long_above, long_below);
      const Mask ends_run = hn::And(usable, hn::Gt(hn::Sub(row, last), noticed));
      if (HWY_UNLIKELY(!hn::AllFalse(d, ends_run))) {
        const Mask started = hn::Ge(last, zero);
        const Mask ends_gap = hn::And(ends_run, started);
        above = Longer(hn::And(ends_gap, high), last, row, above);
        below = Longer(hn::AndNot(high, ends_gap), last, row, below);
        first = hn::IfThenElse(hn::AndNot(started, ends_run), row, first);
        long_above = hn::Sub(above.to, above.from);
        long_below = hn::Sub(below.to, below.from);
      }
      last = hn::IfThenElse(usable, row, last);
    };
    bool was_whole = false;  // the row before, in all lanes: no run ends at the next
    for (std::size_t r = 0; r < block.RowCount(); r += kGroupRows) {
      const RowRange rows = block.RowsOfGroup(r / kGroupRows);
      const Vec least = hn::Load(d, band.least_depth + r / kGroupRows * kBlockBearings + i);
      if (block.AreShared(rows) && hn::AllTrue(d, hn::Ge(least, min_depth))) {
        if (!was_whole) take(rows.first, hn::Eq(zero, zero));
        last = hn::Set(d, static_cast<float>(rows.last));
        was_whole = true;
        continue;
      }
      const Vec nearest = hn::Load(d, band.nearest + r / kGroupRows * kBlockBearings + i);
      if (hn::AllTrue(d, hn::Ge(nearest, hn::Set(d, kUnusable)))) {  // nothing is usable
        was_whole = false;
        continue;
      }
      const float* HWY_RESTRICT samples = band.samples + r * kBlockBearings + i;
      for (int v = rows.first; v <= rows.last; ++v, samples += kBlockBearings) {
        const Mask usable = hn::Lt(hn::Load(d, samples), hn::Set(d, kUnusable));
        const bool is_whole = hn::AllTrue(d, usable);
        if (is_whole && was_whole) {
          last = hn::Set(d, static_cast<float>(v));
          continue;
        }
        if (!hn::AllFalse(d, usable)) take(v, usable);
        was_whole = is_whole;
      }
    }
    hn::Store(first, d, &out.first[i]);
    hn::Store(hn::Max(last, hn::Set(d, -1.0F)), d, &out.last[i]);
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

HWY_EXPORT(MeanLanes);
HWY_EXPORT(MeanLanesUpTo);
HWY_EXPORT(ViewLanes);

BlockMean MeanWithin(const BandSamples& band, std::size_t rows, const BlockLane& low,
                     const BlockLane& high, const BlockLane& otherwise) {
  BlockMean mean;
  HWY_DYNAMIC_DISPATCH(MeanLanes)(band, rows, low, high, otherwise, mean);
  return mean;
}

BlockMean MeanUpTo(const BandSamples& band, std::size_t rows, const BlockLane& high,
                   const BlockLane& otherwise) {
  BlockMean mean;
  HWY_DYNAMIC_DISPATCH(MeanLanesUpTo)(band, rows, high, otherwise, mean);
  return mean;
}

BlockViews FindViews(const BearingBlock& block, const BlockLane& least_depth,
                     const BandSamples& band, float min_depth_m) {
  BlockViews views;
  HWY_DYNAMIC_DISPATCH(ViewLanes)(block, least_depth, band, min_depth_m, views);
  return views;
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
