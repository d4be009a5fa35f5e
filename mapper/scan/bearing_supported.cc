// The nearest surfaces of many bearings at once, one per vector lane (bearing_block.h).
#include <array>
#include <limits>

#include "mapper/scan/bearing_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_supported.cc"
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
    if constexpr (hn::MaxLanes(Floats()) == 16) {  // saves half the operations (masks)
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
  HWY_INLINE Vec MeanOr(Floats d, Vec otherwise) const {
    const Mask any = hn::Gt(count, hn::Zero(d));
    return hn::IfThenElse(any, hn::Div(sum, hn::Max(count, hn::Set(d, 1.0F))), otherwise);
  }
};

// Number of vectors summed at a time: the additions of one vector depend on each other, and
// interleaving several hides their latency.
constexpr std::size_t kTogether = 4;

// Adds up the vectors of a block from lane `at` on.
template <bool kFromLeast>
HWY_INLINE void AddAll(const BandSamples& band, std::size_t rows, std::size_t at,
                       std::array<Running<kFromLeast>, kTogether>& running) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const Vec none = hn::Set(d, -std::numeric_limits<float>::infinity());
  auto [r0, r1, r2, r3] = running;
  const Vec to0 = r0.to, to1 = r1.to, to2 = r2.to, to3 = r3.to;
  for (std::size_t first = 0; first < rows; first += kGroupRows) {
    // Lanes without a near sample may have undefined samples, none of which counts.
    const float* HWY_RESTRICT nearest = band.nearest + first / kGroupRows * kBlockBearings + at;
    const auto limit = [&](std::size_t k, Vec to) HWY_ATTR {
      return hn::IfThenElse(hn::Le(hn::Load(d, nearest + k * lanes), to), to, none);
    };
    r0.to = limit(0, to0);
    r1.to = limit(1, to1);
    r2.to = limit(2, to2);
    r3.to = limit(3, to3);
    const Vec any = hn::Max(hn::Max(r0.to, r1.to), hn::Max(r2.to, r3.to));
    if (hn::AllTrue(d, hn::Le(any, none))) continue;
    const float* HWY_RESTRICT row = band.samples + first * kBlockBearings + at;
    const float* const end = row + std::min(kGroupRows, rows - first) * kBlockBearings;
    for (; row != end; row += kBlockBearings) {
      r0.Add(d, hn::Load(d, row));
      r1.Add(d, hn::Load(d, row + lanes));
      r2.Add(d, hn::Load(d, row + 2 * lanes));
      r3.Add(d, hn::Load(d, row + 3 * lanes));
    }
  }
  r0.to = to0, r1.to = to1, r2.to = to2, r3.to = to3;
  running = {r0, r1, r2, r3};
}

// FindNearest for a vector of bearings.
class NearestLanes {
 public:
  NearestLanes(const BandFound& found, const ReturnLimits& limits, const float* width_m,
               std::size_t at)
      : found_(found), limits_(limits), at_(at) {
    const Floats d;
    nearest_ = hn::Load(d, &found.nearest[at]);
    width_ = hn::Load(d, width_m + at);
    max_range_ = hn::Set(d, limits.max_range_m);
  }
  HWY_INLINE Running<true> First() const {
    const Floats d;
    const Vec high = hn::Min(hn::Add(nearest_, width_), max_range_);
    return {high, high, hn::Zero(d), hn::Zero(d)};
  }
  HWY_INLINE Running<false> Second(const Running<true>& first) {
    mattered_ = first.to;
    count_ = first.count;
    return Around(first.MeanOr(Floats(), nearest_));
  }
  HWY_INLINE void Keep(const Running<false>& of) { range_ = of.MeanOr(Floats(), centre_); }
  HWY_INLINE bool AnyNarrow() const { return !hn::AllFalse(Floats(), Narrow()); }
  // Sums around the current range in lanes with a narrow window; around the old centre in the
  // others.
  HWY_INLINE Running<false> Again() { return Around(hn::IfThenElse(Narrow(), range_, centre_)); }
  HWY_INLINE void Take(BlockHits& hits, NearestOfBlock& of) const {
    const Floats d;
    const Mask any = hn::Le(nearest_, max_range_);
    const auto enough = hn::Set(d, static_cast<float>(limits_.min_returns));
    const Mask is_hit = hn::And(any, hn::Ge(count_, enough));
    hn::Store(hn::IfThenElseZero(is_hit, hn::Set(d, 1.0F)), d, &hits.is_hit[at_]);
    hn::Store(hn::IfThenElseZero(is_hit, range_), d, &hits.range_m[at_]);
    const Vec skipped_from = hn::Load(d, &found_.skipped_from[at_]);
    of.doubtful |= BitsOf(hn::And(is_hit, hn::Ge(mattered_, skipped_from)));
    of.alone |= BitsOf(hn::AndNot(is_hit, any));
  }

 private:
  HWY_INLINE std::uint64_t BitsOf(Mask mask) const {
    std::uint64_t bits = 0;
    hn::StoreMaskBits(Floats(), mask, reinterpret_cast<std::uint8_t*>(&bits));
    return bits << at_;
  }

  HWY_INLINE Mask Narrow() const {
    const Vec most = hn::Set(Floats(), static_cast<float>(NoiseWindow::kMaxWindowM));
    return hn::And(hn::Ge(width_, most), hn::Le(nearest_, max_range_));
  }
  HWY_INLINE Running<false> Around(Vec centre) {
    const Floats d;
    const Vec half = hn::Mul(hn::Set(d, 0.5F), width_);
    const Vec high = hn::Min(hn::Add(centre, half), max_range_);
    centre_ = centre;
    mattered_ = hn::Max(mattered_, high);
    return {hn::Sub(centre, half), high, hn::Zero(d), hn::Zero(d)};
  }

  const BandFound& found_;
  const ReturnLimits& limits_;
  std::size_t at_;
  Vec nearest_, width_, max_range_, centre_, range_, mattered_, count_;
};

void FindLanes(const BandFound& found, std::size_t rows, const ReturnLimits& limits,
               const BlockLane& width_m, BlockHits& hits, NearestOfBlock& of) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  static_assert(kBlockBearings % (kTogether * hn::MaxLanes(Floats())) == 0);
  for (std::size_t i = 0; i < kBlockBearings; i += kTogether * lanes) {
    const auto at = [&](std::size_t k) {
      return NearestLanes(found, limits, width_m.data(), i + k * lanes);
    };
    std::array<NearestLanes, kTogether> nearest{at(0), at(1), at(2), at(3)};
    std::array<Running<true>, kTogether> first;
    for (std::size_t k = 0; k < kTogether; ++k) first[k] = nearest[k].First();
    AddAll(found.samples, rows, i, first);
    std::array<Running<false>, kTogether> around;
    for (std::size_t k = 0; k < kTogether; ++k) around[k] = nearest[k].Second(first[k]);
    for (int mean = 1;; ++mean) {
      AddAll(found.samples, rows, i, around);
      for (std::size_t k = 0; k < kTogether; ++k) nearest[k].Keep(around[k]);
      if (mean == NoiseWindow::kMeansOfCapped) break;
      bool any_narrow = false;
      for (const NearestLanes& lane : nearest) any_narrow = any_narrow || lane.AnyNarrow();
      if (!any_narrow) break;
      for (std::size_t k = 0; k < kTogether; ++k) around[k] = nearest[k].Again();
    }
    for (const NearestLanes& lane : nearest) lane.Take(hits, of);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(FindLanes);

NearestOfBlock FindSupported(const BandFound& found, std::size_t rows, const ReturnLimits& limits,
                             const NoiseWindow& window, BlockHits& hits) {
  BlockLane width_m;
  window.At(found.nearest, width_m.data());
  NearestOfBlock nearest;
  HWY_DYNAMIC_DISPATCH(FindLanes)(found, rows, limits, width_m, hits, nearest);
  return nearest;
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
