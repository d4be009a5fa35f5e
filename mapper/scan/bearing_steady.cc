// The slice's ranges where its upper or lower part differs in range from its core, and where its
// surface leans (bearing_block.h).
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

enum class Direction { kDown, kUp };  // the image; rows increase downwards

// Calls take(row, inside, sample) for each row with samples within the window.
template <Direction kDirection = Direction::kDown, typename Take>
HWY_INLINE void ForSamples(const BearingBlock& block, const BandSamples& band, std::size_t at,
                           const Window& window, const Take& take) {
  const Floats d;
  constexpr bool kDown = kDirection == Direction::kDown;
  const Vec none = hn::Set(d, -1.0F);
  const std::size_t groups = block.GroupCount();
  for (std::size_t k = 0; k < groups; ++k) {
    const std::size_t group = kDown ? k : groups - 1 - k;
    // Lanes without a near sample may have undefined samples, none of which counts.
    const Vec nearest = hn::Load(d, band.nearest + group * kBlockBearings + at);
    const Mask near = hn::Le(nearest, window.to);
    if (hn::AllFalse(d, near)) continue;
    const Vec to = hn::IfThenElse(near, window.to, none);
    const RowRange rows = block.RowsOfGroup(group);
    const float* HWY_RESTRICT samples = band.samples + group * kGroupRows * kBlockBearings + at;
    for (int i = 0; i <= rows.last - rows.first; ++i) {
      const int v = kDown ? rows.first + i : rows.last - i;
      const Vec sample =
          hn::Load(d, samples + static_cast<std::size_t>(v - rows.first) * kBlockBearings);
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

// As in find_nearest.cc, the same operations in the same order.
struct LineSums {
  Vec n, h, r, hh, hr;

  HWY_INLINE LineSums() { n = h = r = hh = hr = hn::Zero(Floats()); }

  HWY_INLINE void Add(Mask taken, Vec behind, Vec height) {
    const auto add = [&](Vec value, Vec& sum)
                         HWY_ATTR { sum = hn::IfThenElse(taken, hn::Add(sum, value), sum); };
    add(hn::Set(Floats(), 1.0F), n);
    add(height, h);
    add(behind, r);
    add(hn::Mul(height, height), hh);
    add(hn::Mul(height, behind), hr);
  }
  HWY_INLINE Vec Det() const { return hn::Sub(hn::Mul(n, hh), hn::Mul(h, h)); }
  HWY_INLINE Vec Lean() const { return hn::Div(hn::Sub(hn::Mul(n, hr), hn::Mul(h, r)), Det()); }
  HWY_INLINE Vec AtZero() const { return hn::Div(hn::Sub(hn::Mul(hh, r), hn::Mul(h, hr)), Det()); }
};

class Leaning {
 public:
  Leaning(Vec from, Vec height, Vec sigma, Vec core) : from_(from), sigma_(sigma), core_at_(core) {
    const Floats d;
    Take(hn::Eq(from, from), hn::Zero(d), height);
    Restart(height);
  }
  HWY_INLINE void Restart(Vec height) {
    last_ = misses_ = hn::Zero(Floats());
    last_height_ = height;
  }
  HWY_INLINE void Follow(Mask is_next, Vec range, Vec height) {
    const Floats d;
    const Mask goes_on = hn::And(is_next, hn::Le(misses_, hn::Set(d, LeaningLimits::kMostMisses)));
    const Vec behind = hn::Sub(range, from_);
    const Vec most = hn::Add(
        hn::Mul(hn::Set(d, LeaningLimits::kNextSigmas), sigma_),
        hn::Mul(hn::Set(d, LeaningLimits::kSteepest), hn::Abs(hn::Sub(height, last_height_))));
    const Mask is_off = hn::Gt(hn::Abs(hn::Sub(behind, last_)), most);
    const Mask taken = hn::AndNot(is_off, goes_on);
    misses_ = hn::IfThenElse(goes_on, hn::Add(misses_, hn::Set(d, 1.0F)), misses_);
    misses_ = hn::IfThenElse(taken, hn::Zero(d), misses_);
    last_ = hn::IfThenElse(taken, hn::Mul(hn::Set(d, 0.5F), hn::Add(last_, behind)), last_);
    last_height_ = hn::IfThenElse(taken, height, last_height_);
    Take(taken, behind, height);
  }
  HWY_INLINE Vec RangeOr(Mask asked, Vec range, float lean_sigmas) const {
    const Floats d;
    const Vec of_half = hn::Set(d, LeaningLimits::kLeastOfHalf);
    const Vec det = all_.Det(), lean = all_.Lean();
    const Vec sigma = hn::Mul(sigma_, hn::Sqrt(hn::Div(all_.n, det)));
    const Vec least =
        hn::Max(hn::Mul(hn::Set(d, lean_sigmas), sigma), hn::Set(d, LeaningLimits::kLeastLean));
    const Vec of_core = hn::Mul(hn::Set(d, LeaningLimits::kLeastOfCore), hn::Mul(lean, lean));
    const Vec before = hn::Sub(hn::Add(from_, nearest_),
                               hn::Mul(hn::Set(d, LeaningLimits::kBeforeSigmas), sigma_));
    Mask leans = hn::And(hn::Ge(below_, of_half), hn::Ge(above_, of_half));
    leans = hn::And(leans, hn::Ge(all_.n, hn::Set(d, LeaningLimits::kLeastSamples)));
    leans = hn::And(leans, hn::Gt(det, hn::Zero(d)));
    leans = hn::And(leans, hn::Ge(hn::Abs(lean), least));
    leans = hn::And(leans, hn::Ge(hn::Mul(core_.Lean(), lean), of_core));
    leans = hn::And(leans, hn::And(asked, hn::Ge(range, before)));
    return hn::IfThenElse(leans, hn::Add(from_, all_.AtZero()), range);
  }

 private:
  HWY_INLINE void Take(Mask taken, Vec behind, Vec height) {
    const Floats d;
    const Vec one = hn::Set(d, 1.0F);
    all_.Add(taken, behind, height);
    core_.Add(hn::And(taken, hn::Le(hn::Abs(height), core_at_)), behind, height);
    const Mask is_below = hn::Lt(height, hn::Zero(d));
    below_ = hn::IfThenElse(hn::And(taken, is_below), hn::Add(below_, one), below_);
    above_ = hn::IfThenElse(hn::AndNot(is_below, taken), hn::Add(above_, one), above_);
    nearest_ = hn::IfThenElse(taken, hn::Min(nearest_, behind), nearest_);
  }

  Vec from_, sigma_, core_at_;
  Vec last_, last_height_, misses_;
  LineSums all_, core_;
  Vec below_ = hn::Zero(Floats()), above_ = hn::Zero(Floats()), nearest_ = hn::Zero(Floats());
};

void LeanLanes(const ImageBands& bands, const BlockLane& width_m, const BearingBlock& block,
               const BandSamples& band, BlockHits& hits) {
  const Floats d;
  const Vec zero = hn::Zero(d);
  const Vec middle_height = hn::Set(d, bands.slice.MiddleM());
  const Window reach{zero, hn::Set(d, bands.limits.max_range_m)};
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const Mask is_hit = hn::Gt(hn::Load(d, &hits.is_hit[i]), zero);
    if (hn::AllFalse(d, is_hit)) continue;
    const Vec range = hn::Load(d, &hits.range_m[i]), width = hn::Load(d, &width_m[i]);
    const Vec half = hn::Mul(hn::Set(d, 0.5F), width);
    const Vec from = hn::Sub(range, half), to = hn::Add(range, half);
    Mask is_wide = hn::Lt(zero, zero);
    ForSamples(block, band, i, reach, [&](Vec, Mask inside, Vec sample) HWY_ATTR {
      is_wide = hn::Or(is_wide, hn::And(inside, hn::Or(hn::Lt(sample, from), hn::Gt(sample, to))));
    });
    is_wide = hn::And(is_wide, is_hit);
    if (hn::AllFalse(d, is_wide)) continue;
    const BearingLineBlock& lines = *block.lines;
    const auto height_at = [&](Vec row, Vec sample) HWY_ATTR {
      const Vec up = hn::Add(hn::Load(d, &lines.g0[i]), hn::Mul(hn::Load(d, &lines.g1[i]), row));
      const Vec ahead = hn::Add(hn::Load(d, &lines.h0[i]), hn::Mul(hn::Load(d, &lines.h1[i]), row));
      return hn::Sub(hn::Mul(sample, hn::Div(up, ahead)), middle_height);
    };
    Vec least = hn::Inf(d), middle = zero, middle_row = zero, height = zero;
    ForSamples(block, band, i, reach, [&](Vec row, Mask inside, Vec sample) HWY_ATTR {
      const Vec here = height_at(row, sample);
      const Mask is_nearer = hn::And(inside, hn::Lt(hn::Abs(here), least));
      least = hn::IfThenElse(is_nearer, hn::Abs(here), least);
      middle = hn::IfThenElse(is_nearer, sample, middle);
      middle_row = hn::IfThenElse(is_nearer, row, middle_row);
      height = hn::IfThenElse(is_nearer, here, height);
    });
    Leaning surface(middle, height, hn::Mul(hn::Set(d, NoiseWindow::kSigmaShare), width),
                    hn::Set(d, bands.slice.CoreHighM() - bands.slice.MiddleM()));
    ForSamples<Direction::kUp>(
        block, band, i, reach, [&](Vec row, Mask inside, Vec sample) HWY_ATTR {
          surface.Follow(hn::And(inside, hn::Lt(row, middle_row)), sample, height_at(row, sample));
        });
    surface.Restart(height);
    ForSamples(block, band, i, reach, [&](Vec row, Mask inside, Vec sample) HWY_ATTR {
      surface.Follow(hn::And(inside, hn::Gt(row, middle_row)), sample, height_at(row, sample));
    });
    hn::Store(surface.RangeOr(is_wide, range, bands.slice.lean_sigmas), d, &hits.range_m[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(SteadyLanes);
HWY_EXPORT(LeanLanes);

void SteadySlice(const ImageBands& bands, const NoiseWindow& window, const BearingBlock& block,
                 const BandFound& found, BlockHits& hits) {
  BlockLane width_m;
  window.At(hits.range_m, width_m.data());
  HWY_DYNAMIC_DISPATCH(SteadyLanes)(bands, width_m, block, found.samples, hits);
}

void LeanSlice(const ImageBands& bands, const NoiseWindow& window, const BearingBlock& block,
               const BandFound& found, BlockHits& hits) {
  BlockLane width_m;
  window.At(hits.range_m, width_m.data());
  HWY_DYNAMIC_DISPATCH(LeanLanes)(bands, width_m, block, found.samples, hits);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
