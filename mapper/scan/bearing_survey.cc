// Least depths and holes of the columns over some rows (bearing_block.h).

#include "mapper/scan/bearing_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mapper/scan/bearing_survey.cc"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::internal {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Vec = hn::Vec<Floats>;

// Neighbouring columns in vectors, aligned to cache lines as far as the image allows. The image is
// at least two vectors wide.
template <int kRows>
void SurveyRows(const DepthImage& image, const RowRange& rows, const Survey& survey) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const std::ptrdiff_t width = image.width_px;
  const int count = kRows > 0 ? kRows : rows.last - rows.first + 1;
  for (int u = survey.first; u < survey.end; u += lanes) {
    const int from = std::min(u, image.width_px - lanes);
    const float* HWY_RESTRICT pixels = image.Row(rows.first) + from;
    Vec low = hn::LoadU(d, pixels), high = low;
    HWY_UNROLL(16)
    for (int r = 1; r < count; ++r) {
      const Vec z = hn::LoadU(d, pixels + r * width);
      low = hn::Min(low, z);
      high = hn::Max(high, z);
    }
    hn::StoreU(low, d, survey.least() + from);
    hn::StoreU(high, d, survey.most() + from);
  }
}

void Columns(const DepthImage& image, const RowRange& rows, const Survey& survey) {
  const bool is_whole = rows.last - rows.first + 1 == static_cast<int>(kGroupRows);
  is_whole ? SurveyRows<static_cast<int>(kGroupRows)>(image, rows, survey)
           : SurveyRows<0>(image, rows, survey);
}

// The first column, at or before `first`, that is aligned to a vector in memory.
int LineBegin(const DepthImage& image, int row, int first) {
  const auto at = reinterpret_cast<std::uintptr_t>(image.Row(row) + first) / sizeof(float);
  return std::max(first - static_cast<int>(at % hn::Lanes(Floats())), 0);
}

constexpr float kVeryFar = 1e30F;

// The last column, which has no right neighbour.
void HolesOfColumn(const DepthImage& image, const RowRange& rows, int u, const Survey& survey) {
  float there = kVeryFar;
  for (int v = rows.first; v <= rows.last; ++v) {
    if (image.At(u, v) > 0.0F) there = std::min(there, image.At(u, v));
  }
  survey.least_there()[u] = there;
  survey.least_of_two()[u] = kVeryFar;  // pixels beyond are never read
}

void Holes(const DepthImage& image, const RowRange& rows, const Survey& survey) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const std::ptrdiff_t width = image.width_px;
  const Vec very_far = hn::Set(d, kVeryFar);
  for (int u = survey.first; u < survey.end; u += lanes) {
    const int from = std::min(u, image.width_px - 1 - lanes);
    const float* HWY_RESTRICT pixels = image.Row(rows.first) + from;
    const Vec least = hn::LoadU(d, survey.least() + from);
    Vec there = very_far, of_two = very_far;
    if (hn::AllTrue(d, hn::Gt(least, hn::Zero(d)))) {  // all pixels are valid
      hn::StoreU(least, d, survey.least_there() + from);
      hn::StoreU(least, d, survey.least_of_two() + from);
      continue;
    }
    for (int v = rows.first; v <= rows.last; ++v, pixels += width) {
      const Vec z = hn::LoadU(d, pixels);
      there = hn::Min(there, hn::IfThenElse(hn::Gt(z, hn::Zero(d)), z, very_far));
      of_two = hn::Min(of_two, hn::Max(z, hn::LoadU(d, pixels + 1)));
    }
    hn::StoreU(there, d, survey.least_there() + from);
    hn::StoreU(of_two, d, survey.least_of_two() + from);
  }
  if (survey.end == image.width_px) HolesOfColumn(image, rows, image.width_px - 1, survey);
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(Columns);
HWY_EXPORT(LineBegin);
HWY_EXPORT(Holes);

void SurveyColumns(const DepthImage& image, const RowRange& rows, int first, int end,
                   Survey& survey) {
  survey.first = HWY_DYNAMIC_DISPATCH(LineBegin)(image, rows.first, first);
  survey.end = end;
  survey.has_holes = false;
  HWY_DYNAMIC_DISPATCH(Columns)(image, rows, survey);
}

void SurveyHoles(const DepthImage& image, const RowRange& rows, Survey& survey) {
  if (survey.has_holes) return;
  survey.has_holes = true;
  HWY_DYNAMIC_DISPATCH(Holes)(image, rows, survey);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
