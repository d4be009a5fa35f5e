// The rows of a block with usable pixels, and the gaps between them (bearing_block.h).
#include "mapper/scan/bearing_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_views.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBlockBearings>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

// The longest gap between two usable rows so far.
struct Gap {
  Vec from, to;
};
HWY_INLINE Gap Longer(Mask here, Vec from, Vec to, const Gap& gap) {
  const Mask longer = hn::And(here, hn::Gt(hn::Sub(to, from), hn::Sub(gap.to, gap.from)));
  return {hn::IfThenElse(longer, from, gap.from), hn::IfThenElse(longer, to, gap.to)};
}

// The last usable row before there is one; makes the gap to the first longer than any other.
constexpr float kNeverSeen = -1e6F;

// For lanes in which every row is usable.
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
  out.has_gaps = false;
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    if (hn::AllTrue(d, hn::Ge(hn::Load(d, &least_depth[i]), min_depth))) {
      SeeAll(block, i, out);
      continue;
    }
    const Vec g0 = hn::Load(d, &block.lines->g0[i]), g1 = hn::Load(d, &block.lines->g1[i]);
    Vec first = zero, last = hn::Set(d, kNeverSeen);
    // A gap has a row between its ends, so their difference exceeds one.
    Gap below{zero, one}, above{zero, one};
    // Gaps up to this length change nothing, except the one before the first usable row.
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
    bool was_whole = false;  // all lanes of the previous row were usable: no gap ends here
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
      if (hn::AllTrue(d, hn::Ge(nearest, hn::Set(d, kUnusable)))) {  // no pixel is usable
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
    const Vec longest = hn::Max(hn::Sub(above.to, above.from), hn::Sub(below.to, below.from));
    out.has_gaps = out.has_gaps || !hn::AllTrue(d, hn::Le(longest, one));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(ViewLanes);

void FindViews(const BearingBlock& block, const BlockLane& least_depth, const BandSamples& band,
               float min_depth_m, BlockViews& views) {
  HWY_DYNAMIC_DISPATCH(ViewLanes)(block, least_depth, band, min_depth_m, views);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
