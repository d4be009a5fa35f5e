// Converts pixels to points and selects those on level surfaces, one per vector lane
// (floor_plane.h).
#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "mapper/scan/floor_plane.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/floor_points.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>
// Must follow foreach_target.h.
#include <hwy/cache_control.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using Vec = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

void PutLanes(const float* HWY_RESTRICT pixels, const float* coming_pixels, int step,
              const Eigen::Vector3f& first, const Eigen::Vector3f& per_column, int row,
              PointGrid& grid) {
  const Floats d;
  const Ints di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto end = hn::Set(di, grid.columns), last = hn::Set(di, std::max(grid.columns - 1, 0));
  const Vec none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const std::size_t at = static_cast<std::size_t>(row) * grid.stride;
  constexpr int kLineFloats = 16;
  for (int c = 0; c < static_cast<int>(grid.stride); c += lanes) {
    const int coming_end = std::min(c + lanes, grid.columns) * step;
    for (int u = c * step; u < coming_end; u += kLineFloats) hwy::Prefetch(coming_pixels + u);
    const auto column = hn::Iota(di, c);
    const Vec seen = hn::GatherIndex(d, pixels, hn::Mul(hn::Min(column, last), hn::Set(di, step)));
    const Mask is_point =
        hn::And(hn::Gt(seen, hn::Zero(d)), hn::RebindMask(d, hn::Lt(column, end)));
    const Vec depth = hn::IfThenElse(is_point, seen, none), k = hn::ConvertTo(d, column);
    const auto put = [&](int axis, std::vector<float>& to) HWY_ATTR {
      const Vec ray = hn::Add(hn::Set(d, first[axis]), hn::Mul(k, hn::Set(d, per_column[axis])));
      hn::StoreU(hn::Mul(depth, ray), d, &to[at + static_cast<std::size_t>(c)]);
    };
    put(0, grid.x);
    put(1, grid.y);
    put(2, grid.z);
  }
}

struct Points {
  Vec x, y, z;
};
HWY_INLINE Points Load(const PointGrid& grid, std::size_t k) {
  const Floats d;
  return {hn::LoadU(d, &grid.x[k]), hn::LoadU(d, &grid.y[k]), hn::LoadU(d, &grid.z[k])};
}

HWY_INLINE Vec Square(Vec v) { return hn::Mul(v, v); }

HWY_INLINE Mask IsLevel(const Points& a, const Points& b, float steepest) {
  const Vec level = hn::Add(Square(hn::Sub(b.x, a.x)), Square(hn::Sub(b.y, a.y)));
  const Vec most = hn::Mul(hn::Set(Floats(), steepest * steepest), level);
  return hn::Le(Square(hn::Sub(b.z, a.z)), most);
}

// Comparisons with NaN are false.
void FindLanes(const PointGrid& grid, const LevelLimits& limits,
               std::vector<Eigen::Vector3f>& points) {
  const Floats d;
  const Vec highest = hn::Set(d, -limits.min_height_m), lowest = hn::Set(d, -limits.max_height_m);
  const Vec farthest = hn::Set(d, limits.max_distance_m * limits.max_distance_m);
  const auto over = static_cast<std::size_t>(limits.over);
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int row = 0; row + limits.over < grid.rows; ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * grid.stride;
    for (std::size_t k = begin; k < begin + columns; k += hn::Lanes(d)) {
      const Points here = Load(grid, k);
      const Mask is_below = hn::And(hn::Le(here.z, highest), hn::Gt(here.z, lowest));
      if (hn::AllFalse(d, is_below)) continue;
      const Mask is_near = hn::Le(hn::Add(Square(here.x), Square(here.y)), farthest);
      const Mask is_level =
          hn::And(IsLevel(here, Load(grid, k + over), limits.steepest),
                  IsLevel(here, Load(grid, k + over * grid.stride), limits.steepest));
      const Mask is_found = hn::And(hn::And(is_below, is_near), is_level);
      std::uint32_t bits = 0;
      hn::StoreMaskBits(d, is_found, reinterpret_cast<std::uint8_t*>(&bits));
      for (; bits != 0; bits &= bits - 1) {
        const std::size_t i = k + static_cast<std::size_t>(std::countr_zero(bits));
        points.emplace_back(grid.x[i], grid.y[i], grid.z[i]);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(PutLanes);
HWY_EXPORT(FindLanes);

void PutPoints(const float* pixels, const float* coming_pixels, int step,
               const Eigen::Vector3f& first, const Eigen::Vector3f& per_column, int row,
               PointGrid& grid) {
  HWY_DYNAMIC_DISPATCH(PutLanes)(pixels, coming_pixels, step, first, per_column, row, grid);
}

void FindLevel(const PointGrid& grid, const LevelLimits& limits,
               std::vector<Eigen::Vector3f>& points) {
  HWY_DYNAMIC_DISPATCH(FindLanes)(grid, limits, points);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
