// The image lines of many bearings at once, one per vector lane (bearing_lines.h).
#include "mapper/scan/bearing_lines.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_lines_block.cc"
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

// Rays closer than this to vertical have no useful bearing (sine of 3 degrees).
constexpr double kMinHorizontal = 0.05;

HWY_INLINE Vec Times(double a, Vec b) { return hn::Mul(hn::Set(Doubles(), a), b); }

// value = at_zero + slope * v, per lane.
struct Linear {
  Vec at_zero, slope;
  HWY_INLINE Vec operator()(Vec v) const { return hn::Add(at_zero, hn::Mul(slope, v)); }
  HWY_INLINE Linear operator-() const { return {hn::Neg(at_zero), hn::Neg(slope)}; }
};

struct Rows {
  Vec low, high;
};

// Rows of [low, high] where `function` >= limit.
HWY_INLINE Rows ClipBelow(const Linear& function, double at_least, const Rows& rows) {
  const Doubles d;
  const Vec limit = hn::Set(d, at_least), zero = hn::Zero(d);
  const Mask is_whole =
      hn::And(hn::Ge(function(rows.low), limit), hn::Ge(function(rows.high), limit));
  if (HWY_LIKELY(hn::AllTrue(d, is_whole))) return rows;  // the usual case needs no division
  const Vec root = hn::Div(hn::Sub(limit, function.at_zero), function.slope);
  const Mask rises = hn::Gt(function.slope, zero), falls = hn::Lt(function.slope, zero);
  const Mask is_none = hn::AndNot(hn::Or(rises, falls), hn::Lt(function.at_zero, limit));
  const Vec low = hn::IfThenElse(rises, hn::Max(rows.low, root), rows.low);
  const Vec high = hn::IfThenElse(falls, hn::Min(rows.high, root), rows.high);
  const Vec before = hn::Sub(rows.low, hn::Set(d, 1.0));
  return {hn::IfThenElse(is_whole, rows.low, low),
          hn::IfThenElse(is_whole, rows.high, hn::IfThenElse(is_none, before, high))};
}

// For a ray (a, b, 1) on a bearing's line, a is linear in b = (v - cy) / fy.
struct RayOfRow {
  Vec a_at_b0, a_slope;
};

// The function f . (a, b, 1) of rays as a linear function of the row.
HWY_INLINE Linear LinearInRow(Vec fx, Vec fy, Vec f1, const RayOfRow& ray, const ImageAxes& axes) {
  const Vec slope = Times(1.0 / axes.fy_px, hn::Add(hn::Mul(fx, ray.a_slope), fy));
  return {hn::Sub(hn::Add(hn::Mul(fx, ray.a_at_b0), f1), Times(axes.cy_px, slope)), slope};
}

// Rows where the line lies between the centres of the outer pixels. In the outer half of those
// depth could only be that of their centre, and a wall that recedes would bend at the image's edge.
HWY_INLINE Rows RowsInImage(const Linear& horizontal, const Linear& column, const ImageAxes& axes) {
  const Doubles d;
  Rows rows{hn::Zero(d), hn::Set(d, axes.height_px - 1.0)};
  rows = ClipBelow(horizontal, kMinHorizontal, rows);
  rows = ClipBelow(column, 0.0, rows);
  return ClipBelow(-column, -(axes.width_px - 1.0), rows);
}

void FindLanes(const ImageAxes& axes, const BlockDirections& directions, BearingLineBlock& lines) {
  const Doubles d;
  const Eigen::Matrix3d& m = axes.level_from_ray;
  const Vec none = hn::Set(d, -1.0);
  for (std::size_t i = 0; i < kBlockBearings; i += hn::Lanes(d)) {
    const Vec c = hn::Load(d, &directions.cosine[i]), s = hn::Load(d, &directions.sine[i]);
    const auto off_plane = [&](int k) HWY_ATTR {
      return hn::Add(Times(m(0, k), hn::Neg(s)), Times(m(1, k), c));
    };
    const auto along = [&](int k)
                           HWY_ATTR { return hn::Add(Times(m(0, k), c), Times(m(1, k), s)); };
    const auto up = [&](int k) HWY_ATTR { return hn::Set(d, m(2, k)); };
    // off_plane . (a, b, 1) = 0, so a is linear in b, and all other quantities too.
    const Vec across = off_plane(0);  // rate at which columns leave the bearing's plane
    const Vec inverse = hn::Div(none, across);
    const RayOfRow ray{hn::Mul(off_plane(2), inverse), hn::Mul(off_plane(1), inverse)};
    const Linear horizontal = LinearInRow(along(0), along(1), along(2), ray, axes);
    const Linear height = LinearInRow(up(0), up(1), up(2), ray, axes);
    const Vec u_slope = Times(1.0 / axes.fy_px, Times(axes.fx_px, ray.a_slope));
    const Vec u_at_row_0 = hn::Sub(hn::Add(hn::Set(d, axes.cx_px), Times(axes.fx_px, ray.a_at_b0)),
                                   Times(axes.cy_px, u_slope));
    const Linear column{u_at_row_0, u_slope};
    const Rows rows = RowsInImage(horizontal, column, axes);
    const Vec below = hn::Set(d, 1.0 * axes.height_px);
    constexpr double kParallel = 1e-9;
    const Mask is_line = hn::Ge(hn::Abs(across), hn::Set(d, kParallel));
    const auto store = [&](Vec number, BlockLane& to) HWY_ATTR {
      hn::StoreU(hn::DemoteTo(Floats(), hn::IfThenElseZero(is_line, number)), Floats(), &to[i]);
    };
    store(column.at_zero, lines.u0);
    store(column.slope, lines.u1);
    store(horizontal.at_zero, lines.h0);
    store(horizontal.slope, lines.h1);
    store(height.at_zero, lines.g0);
    store(height.slope, lines.g1);
    store(hn::Ceil(hn::Min(hn::Max(rows.low, none), below)), lines.first_row);
    const Vec last = hn::Floor(hn::Max(rows.high, none));
    const Vec last_row = hn::IfThenElse(is_line, last, none);
    hn::StoreU(hn::DemoteTo(Floats(), last_row), Floats(), &lines.last_row[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(FindLanes);

void FindLines(const ImageAxes& axes, const BlockDirections& directions, BearingLineBlock& lines) {
  HWY_DYNAMIC_DISPATCH(FindLanes)(axes, directions, lines);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
