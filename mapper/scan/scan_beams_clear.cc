// ClearInterval (clear_interval.h) of many bearings at once, one a vector lane; each lane computes
// the same operation by operation, so the values are the same bit for bit.
#include <limits>

#include "mapper/scan/scan_beams.h"

// x86-64-v3 has AVX2 without AES, which nothing here needs.
#define HWY_DISABLE_PCLMUL_AES
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/scan_beams_clear.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::Rebind<float, Doubles>;
using Vec = hn::Vec<Doubles>;
using Mask = hn::Mask<Doubles>;
static_assert(BearingViews::kBatch % hn::MaxLanes(Doubles()) == 0);

// Edges of the band above the camera, and what may hide in a gap.
struct Band {
  double low_m, high_m, max_gap_m;
};

struct Interval {
  Vec from, to;
};

HWY_INLINE Vec Widened(const std::vector<float>& numbers, std::size_t k) {
  return hn::PromoteTo(Doubles(), hn::LoadU(Floats(), &numbers[k]));
}

// Where the band's lower edge is seen. The camera looks down on it or up.
template <bool kLooksDown>
HWY_INLINE Interval WhereEdgeIsSeen(const Slopes& seen, std::size_t k, Vec rise, Mask& any) {
  const Doubles d;
  const Vec never = hn::Set(d, std::numeric_limits<double>::infinity()), zero = hn::Zero(d);
  const Vec low = Widened(seen.low, k), high = Widened(seen.high, k);
  if constexpr (kLooksDown) {
    any = hn::Lt(low, zero);
    return {hn::Div(rise, low), hn::IfThenElse(hn::Lt(high, zero), hn::Div(rise, high), never)};
  }
  any = hn::Gt(high, zero);
  return {hn::Div(rise, high), hn::IfThenElse(hn::Gt(low, zero), hn::Div(rise, low), never)};
}

HWY_INLINE Interval Without(const Interval& clear, const Slopes& gaps, std::size_t k,
                            const Band& band) {
  const Doubles d;
  const Vec never = hn::Set(d, std::numeric_limits<double>::infinity()), zero = hn::Zero(d);
  const Vec low = Widened(gaps.low, k), high = Widened(gaps.high, k);
  const Mask is_gap = hn::Lt(low, high);
  if (hn::AllFalse(d, is_gap)) return clear;
  const Vec below =
      hn::IfThenElse(hn::Lt(high, zero), hn::Div(hn::Set(d, band.low_m), high), never);
  const Vec to = hn::IfThenElse(hn::Gt(low, zero), hn::Div(hn::Set(d, band.high_m), low), below);
  const Vec slopes = hn::PromoteTo(  // the difference of two floats is one
      d, hn::Sub(hn::LoadU(Floats(), &gaps.high[k]), hn::LoadU(Floats(), &gaps.low[k])));
  const Vec from = hn::Div(hn::Set(d, band.max_gap_m), slopes);
  const Mask meets = hn::And(hn::Lt(from, clear.to), hn::Gt(to, clear.from));
  const Mask hides = hn::And(hn::And(is_gap, meets), hn::Lt(from, to));
  const Mask keeps_before = hn::Ge(hn::Sub(from, clear.from), hn::Sub(clear.to, to));
  return {hn::IfThenElse(hn::AndNot(keeps_before, hides), to, clear.from),
          hn::IfThenElse(hn::And(keeps_before, hides), from, clear.to)};
}

template <bool kLooksDown>
void FindBatch(const BearingViews& views, std::size_t begin, const Band& band, BeamNumbers& beams) {
  const Doubles d;
  const bool has_gap = views.has_gap[begin / BearingViews::kBatch] != 0;
  for (std::size_t k = begin; k < begin + BearingViews::kBatch; k += hn::Lanes(d)) {
    Mask any;
    Interval clear = WhereEdgeIsSeen<kLooksDown>(views.seen, k, hn::Set(d, band.low_m), any);
    clear.to = hn::Min(clear.to, hn::LoadU(d, &beams.limit_m[k]));
    if (has_gap) {
      clear = Without(clear, views.below, k, band);
      clear = Without(clear, views.above, k, band);
    }
    const Mask is_clear = hn::And(any, hn::Lt(clear.from, clear.to));
    const auto store = [&](Vec distance, std::vector<float>& to) HWY_ATTR {
      hn::StoreU(hn::DemoteTo(Floats(), hn::IfThenElseZero(is_clear, distance)), Floats(), &to[k]);
    };
    store(clear.from, beams.clear_from_m);
    store(clear.to, beams.clear_to_m);
  }
}

void FindClearLanes(const BearingViews& views, double camera_height_m, const ScanOptions& options,
                    BeamNumbers& beams) {
  const Band band{options.band_low_m - camera_height_m, options.band_high_m - camera_height_m,
                  options.max_gap_m};
  for (std::size_t k = 0; k < beams.limit_m.size(); k += BearingViews::kBatch) {
    band.low_m < 0.0 ? FindBatch<true>(views, k, band, beams)
                     : FindBatch<false>(views, k, band, beams);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(FindClearLanes);

void FindClear(const BearingViews& views, double camera_height_m, const ScanOptions& options,
               BeamNumbers& beams) {
  HWY_DYNAMIC_DISPATCH(FindClearLanes)(views, camera_height_m, options, beams);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
