// What the columns of some rows hold (bearing_block.h).
#include <cstdint>

#include "mapper/scan/bearing_block.h"

// x86-64-v3 has AVX2 without AES, which nothing here needs.
#define HWY_DISABLE_PCLMUL_AES
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

// Neighbouring columns by vectors that begin where lines of memory do, as far as the image allows:
// it is two vectors wide or more.
template <int kRows>
void SurveyRows(const DepthImage& image, const RowRange& rows, int first, int end,
                float* HWY_RESTRICT least, float* HWY_RESTRICT most) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const std::ptrdiff_t width = image.width_px;
  const int count = kRows > 0 ? kRows : rows.last - rows.first + 1;
  for (int u = first; u < end; u += lanes) {
    const int from = std::min(u, image.width_px - lanes);
    const float* HWY_RESTRICT pixels = image.Row(rows.first) + from;
    Vec low = hn::LoadU(d, pixels), high = low;
    HWY_UNROLL(16)
    for (int r = 1; r < count; ++r) {
      const Vec z = hn::LoadU(d, pixels + r * width);
      low = hn::Min(low, z);
      high = hn::Max(high, z);
    }
    hn::StoreU(low, d, least + from);
    hn::StoreU(high, d, most + from);
  }
}

void Survey(const DepthImage& image, const RowRange& rows, int first, int end, float* least,
            float* most) {
  const auto lanes = hn::Lanes(Floats());
  const auto at = reinterpret_cast<std::uintptr_t>(image.Row(rows.first) + first) / sizeof(float);
  const int begin = std::max(first - static_cast<int>(at % lanes), 0);
  const bool is_whole = rows.last - rows.first + 1 == static_cast<int>(kGroupRows);
  is_whole ? SurveyRows<static_cast<int>(kGroupRows)>(image, rows, begin, end, least, most)
           : SurveyRows<0>(image, rows, begin, end, least, most);
}

}  // namespace HWY_NAMESPACE
}  // namespace depthgrid::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::internal {

HWY_EXPORT(Survey);

void SurveyColumns(const DepthImage& image, const RowRange& rows, int first, int end,
                   std::vector<float>& survey) {
  const auto width = static_cast<std::size_t>(image.width_px);
  survey.resize(2 * width);
  HWY_DYNAMIC_DISPATCH(Survey)(image, rows, first, end, survey.data(), survey.data() + width);
}

}  // namespace depthgrid::internal
#endif  // HWY_ONCE
