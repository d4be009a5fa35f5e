// The slice's ranges where its upper or lower part differs in range from its core
// (bearing_block.h).
#include "mapper/scan/bearing_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_steady.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kBlockBearings>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

struct Sum {
  Vec sum, count;

  HWY_INLINE void Add(Mask taken, Vec sample) {
    const Floats d;
    sum = hn::IfThenElse(taken, hn::Add(sum, sample), sum);
    count = hn::IfThenElse(taken, hn::Add(count, hn::Set(d, 1.0F)), count);
  }
  // NaN if there are no samples.
  HWY_INLINE Vec Mean() const { return hn::Div(sum, count); }
};

struct CoreRows {
  Vec first, last;

  HWY_INLINE Mask Contain(Vec row) const { return hn::And(hn::Ge(row, first), hn::Le(row, last)); }
};

struct Window {
  Vec from, to;
};

HWY_INLINE Vec RowAtSlope(const BearingLineBlock& lines, std::size_t at, Vec slope) {
  const Floats d;
  return hn::Div(hn::Sub(hn::Mul(slope, hn::Load(d, &lines.h0[at])), hn::Load(d, &lines.g0[at])),
                 hn::Sub(hn::Load(d, &lines.g1[at]), hn::Mul(slope, hn::Load(d, &lines.h1[at]))));
}

HWY_INLINE CoreRows CoreRowsOf(const BearingLineBlock& lines, std::size_t at,
                               const SliceBand& slice, Vec range) {
  const Floats d;
  const Vec a = RowAtSlope(lines, at, hn::Div(hn::Set(d, slice.CoreHighM()), range));
  const Vec b = RowAtSlope(lines, at, hn::Div(hn::Set(d, slice.CoreLowM()), range));
  const Mask ordered = hn::Lt(a, b);
  return {hn::IfThenElse(ordered, a, b), hn::IfThenElse(ordered, b, a)};
}

HWY_INLINE Mask Agree(const Sum& part, const Sum& core, Vec limit) {
  const Floats d;
  const Vec difference = hn::Sub(part.Mean(), core.Mean());
  const Vec square = hn::Mul(hn::Mul(difference, difference), hn::Mul(part.count, core.count));
  const Vec most = hn::Mul(hn::Mul(limit, limit), hn::Add(part.count, core.count));
  return hn::Or(hn::Eq(part.count, hn::Zero(d)), hn::Le(square, most));
}

// Calls take(row, inside, sample) for each row with samples within the window.
template <typename Take>
HWY_INLINE void ForSamples(const BearingBlock& block, const BandSamples& band, std::size_t at,
                           const Window& window, const Take& take) {
  const Floats d;
  const Vec none = hn::Set(d, -1.0F);
  for (std::size_t group = 0; group < block.GroupCount(); ++group) {
    // Lanes without a near sample may have undefined samples, none of which counts.
    const Vec nearest = hn::Load(d, band.nearest + group * kBlockBearings + at);
    const Mask near = hn::Le(nearest, window.to);
    if (hn::AllFalse(d, near)) continue;
    const Vec to = hn::IfThenElse(near, window.to, none);
    const RowRange rows = block.RowsOfGroup(group);
    const float* HWY_RESTRICT samples = band.samples + group * kGroupRows * kBlockBearings + at;
    for (int v = rows.first; v <= rows.last; ++v, samples += kBlockBearings) {
      const Vec sample = hn::Load(d, samples);
      const Mask inside = hn::And(hn::Le(sample, to), hn::Ge(sample, window.from));
      take(hn::Set(d, static_cast<float>(v)), inside, sample);
    }
  }
}

void SteadyLanes(const ImageBands& bands, const BlockLane& width_m, const BearingBlock& block,
                 const BandSamples& band, BlockHits& hits) {
  const Floats d;
  const Vec zero = hn::Zero(d), needed = hn::Set(d, static_cast<float>(bands.limits.min_returns));
  const Vec max_range = hn::Set(d, bands.limits.max_range_m);
  const Vec sigmas = hn::Set(d, bands.slice.agree_sigmas * NoiseWindow::kSigmaShare);
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const Mask is_hit = hn::Gt(hn::Load(d, &hits.is_hit[i]), zero);
    if (hn::AllFalse(d, is_hit)) continue;
    const Vec range = hn::Load(d, &hits.range_m[i]), width = hn::Load(d, &width_m[i]);
    const Vec half = hn::Mul(hn::Set(d, 0.5F), width);
    const auto around = [&](Vec centre) HWY_ATTR {
      return Window{hn::Sub(centre, half), hn::Min(hn::Add(centre, half), max_range)};
    };
    const CoreRows rows = CoreRowsOf(*block.lines, i, bands.slice, range);
    Sum before{zero, zero}, core{zero, zero}, after{zero, zero};
    ForSamples(block, band, i, around(range), [&](Vec row, Mask inside, Vec sample) HWY_ATTR {
      const Mask is_before = hn::Lt(row, rows.first), is_after = hn::Gt(row, rows.last);
      before.Add(hn::And(inside, is_before), sample);
      after.Add(hn::And(inside, is_after), sample);
      core.Add(hn::And(inside, rows.Contain(row)), sample);
    });
    const Vec limit = hn::Mul(sigmas, width);
    const Mask steady = hn::And(Agree(before, core, limit), Agree(after, core, limit));
    const Mask is_known = hn::And(is_hit, hn::Ge(core.count, needed));
    const Mask alone = hn::AndNot(steady, is_known);
    if (hn::AllFalse(d, alone)) continue;
    Sum inner{zero, zero};
    ForSamples(block, band, i, around(core.Mean()), [&](Vec row, Mask inside, Vec sample) HWY_ATTR {
      inner.Add(hn::And(inside, rows.Contain(row)), sample);
    });
    const Mask found = hn::And(alone, hn::Ge(inner.count, needed));
    hn::Store(hn::IfThenElse(found, inner.Mean(), range), d, &hits.range_m[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SteadyLanes);

void SteadySlice(const ImageBands& bands, const NoiseWindow& window, const BearingBlock& block,
                 const BandFound& found, BlockHits& hits) {
  BlockLane width_m;
  window.At(hits.range_m, width_m.data());
  HWY_DYNAMIC_DISPATCH(SteadyLanes)(bands, width_m, block, found.samples, hits);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
