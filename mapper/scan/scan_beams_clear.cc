// Slopes of rays and ClearInterval (clear_interval.h) of many bearings at once, one per vector
// lane. Each lane performs the same operations, so the values are equal bit for bit.
#include <limits>

#include "mapper/scan/scan_beams.h"

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
static_assert(kBlockBearings % hn::MaxLanes(Doubles()) == 0);

// Heights of the band's edges above the camera, and the tallest allowed gap.
struct Band {
  double low_m, high_m, max_gap_m;
};

struct Interval {
  Vec from, to;
};

HWY_INLINE Vec Widened(const std::vector<float>& numbers, std::size_t k) {
  return hn::PromoteTo(Doubles(), hn::LoadU(Floats(), &numbers[k]));
}

// Where the band's lower edge is in view, for an edge below (kLooksDown) or above the camera.
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
  const Vec slopes = hn::PromoteTo(  // the difference of two floats is a float
      d, hn::Sub(hn::LoadU(Floats(), &gaps.high[k]), hn::LoadU(Floats(), &gaps.low[k])));
  const Vec from = hn::Div(hn::Set(d, band.max_gap_m), slopes);
  const Mask meets = hn::And(hn::Lt(from, clear.to), hn::Gt(to, clear.from));
  const Mask hides = hn::And(hn::And(is_gap, meets), hn::Lt(from, to));
  const Mask keeps_before = hn::Ge(hn::Sub(from, clear.from), hn::Sub(clear.to, to));
  return {hn::IfThenElse(hn::AndNot(keeps_before, hides), to, clear.from),
          hn::IfThenElse(hn::And(keeps_before, hides), from, clear.to)};
}

template <bool kLooksDown>
void FindBlock(const BearingViews& views, const BlockHits& hits, std::size_t block,
               const Band& band, double max_range_m, BeamNumbers& beams) {
  const Doubles d;
  const Vec max_range = hn::Set(d, max_range_m);
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const std::size_t k = block * kBlockBearings + i;
    const Vec is_hit = hn::PromoteTo(d, hn::Load(Floats(), &hits.is_hit[i]));
    const Vec range = hn::PromoteTo(d, hn::Load(Floats(), &hits.range_m[i]));
    Mask any;
    Interval clear = WhereEdgeIsSeen<kLooksDown>(views.seen, k, hn::Set(d, band.low_m), any);
    const Vec limit = hn::IfThenElse(hn::Gt(is_hit, hn::Zero(d)), range, max_range);
    clear.to = hn::Min(clear.to, limit);
    if (views.has_gap[block] != 0) {
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

void FindClearLanes(const BearingViews& views, const std::vector<BlockHits>& hits,
                    double camera_height_m, const ScanOptions& options, BeamNumbers& beams) {
  const Band band{options.band_low_m - camera_height_m, options.band_high_m - camera_height_m,
                  options.max_gap_m};
  const auto find = band.low_m < 0.0 ? &FindBlock<true> : &FindBlock<false>;
  for (std::size_t b = 0; b < hits.size(); ++b) {
    find(views, hits[b], b, band, options.max_range_m, beams);
  }
}

// Slopes of the rays in rows `first` and `last` of each bearing, if these are far enough apart;
// else `none` and its negative.
struct RaysOfBlock {
  const BearingLineBlock* lines;
  const BlockLane *first, *last;
  float least_apart, none;
};
void FindSlopesOf(const RaysOfBlock& rays, float* HWY_RESTRICT low, float* HWY_RESTRICT high) {
  const hn::CappedTag<float, kBlockBearings> d;
  const BearingLineBlock& lines = *rays.lines;
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const auto first = hn::Load(d, &(*rays.first)[i]), last = hn::Load(d, &(*rays.last)[i]);
    const auto slope_at = [&](auto row) HWY_ATTR {
      const auto g = hn::Add(hn::Load(d, &lines.g0[i]), hn::Mul(hn::Load(d, &lines.g1[i]), row));
      const auto h = hn::Add(hn::Load(d, &lines.h0[i]), hn::Mul(hn::Load(d, &lines.h1[i]), row));
      return hn::Div(g, h);
    };
    const auto a = slope_at(first), b = slope_at(last);
    const auto any = hn::Ge(hn::Sub(last, first), hn::Set(d, rays.least_apart));
    const auto lower = hn::IfThenElse(hn::Lt(b, a), b, a);
    const auto higher = hn::IfThenElse(hn::Lt(a, b), b, a);
    hn::StoreU(hn::IfThenElse(any, lower, hn::Set(d, rays.none)), d, low + i);
    hn::StoreU(hn::IfThenElse(any, higher, hn::Set(d, -rays.none)), d, high + i);
  }
}

void FindSlopeLanes(const BearingLineBlock& lines, const BlockViews& rows, std::size_t block,
                    BearingViews& views) {
  const std::size_t at = block * kBlockBearings;
  constexpr float kNever = std::numeric_limits<float>::infinity();
  FindSlopesOf({&lines, &rows.first, &rows.last, 0.0F, kNever}, &views.seen.low[at],
               &views.seen.high[at]);
  views.has_gap[block] = rows.has_gaps ? 1 : 0;
  if (!rows.has_gaps) {  // no gaps to look for
    return;
  }
  constexpr float kGapRows = 2.0F;
  FindSlopesOf({&lines, &rows.below_from, &rows.below_to, kGapRows, 0.0F}, &views.below.low[at],
               &views.below.high[at]);
  FindSlopesOf({&lines, &rows.above_from, &rows.above_to, kGapRows, 0.0F}, &views.above.low[at],
               &views.above.high[at]);
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(FindClearLanes);
HWY_EXPORT(FindSlopeLanes);

void FindClear(const BearingViews& views, const std::vector<BlockHits>& hits,
               double camera_height_m, const ScanOptions& options, BeamNumbers& beams) {
  HWY_DYNAMIC_DISPATCH(FindClearLanes)(views, hits, camera_height_m, options, beams);
}

void FindSlopes(const BearingLineBlock& lines, const BlockViews& rows, std::size_t block,
                BearingViews& views) {
  HWY_DYNAMIC_DISPATCH(FindSlopeLanes)(lines, rows, block, views);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
