// Widths of the noise window at many ranges, one a vector lane; the same bit for bit as
// NoiseWindow::At of each.
#include "mapper/core/error.h"
#include "mapper/scan/noise_window.h"

// x86-64-v3 has AVX2 without AES, which nothing here needs.
#define HWY_DISABLE_PCLMUL_AES
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/noise_widths.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::Rebind<float, Doubles>;
using Wholes = hn::RebindToSigned<Doubles>;
using Vec = hn::Vec<Doubles>;

void WidthLanes(const WidthRule& rule, const float* HWY_RESTRICT ranges_m, std::size_t count,
                float* HWY_RESTRICT widths_m) {
  const Doubles d;
  const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const Vec last = hn::Set(d, rule.classes - 1.0), last_below = hn::Set(d, rule.classes - 2.0);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec z = hn::PromoteTo(d, hn::LoadU(Floats(), ranges_m + i));
    const Vec classes = hn::Sub(hn::Div(z, hn::Set(d, rule.class_m)), hn::Set(d, 0.5));
    const Vec position = hn::Min(hn::Max(classes, zero), last);
    const Vec below = hn::Min(hn::Floor(position), last_below);
    const Vec share = hn::Sub(position, below);
    const auto index = hn::ConvertTo(Wholes(), below);
    const Vec at_below = hn::GatherIndex(d, rule.inverse_sigma, index);
    const Vec at_above = hn::GatherIndex(d, rule.inverse_sigma + 1, index);
    const Vec inverse = hn::Add(hn::Mul(hn::Sub(one, share), at_below), hn::Mul(share, at_above));
    const Vec sigma = hn::Mul(hn::Mul(z, z), inverse);
    const Vec width =
        hn::Min(hn::Max(hn::Mul(hn::Set(d, rule.sigmas), sigma), hn::Set(d, rule.min_m)),
                hn::Set(d, rule.max_m));
    hn::StoreU(hn::DemoteTo(Floats(), width), Floats(), widths_m + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(WidthLanes);

void FindWidths(const WidthRule& rule, std::span<const float> ranges_m, float* widths_m) {
  Require(ranges_m.size() % 16 == 0, "widths are found of whole vectors");
  HWY_DYNAMIC_DISPATCH(WidthLanes)(rule, ranges_m.data(), ranges_m.size(), widths_m);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
