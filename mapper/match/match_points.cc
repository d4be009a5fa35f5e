#include "mapper/match/match_points.h"

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Beyond any laser's range; keeps cell indices of corrupt ranges within int.
constexpr float kFarthestUsedM = 1e4F;
// Two turns: beyond any scanner's bearing and within the accurate range of the vectorised sine.
constexpr float kLargestBearingRad = static_cast<float>(4.0 * kPi);

// Replaces (bearing, range) by (x, y), in place.
void ToPoints(std::size_t count, float* bearing_then_x, float* range_then_y) {
  const hn::CappedTag<float, 8> lanes;
  const std::size_t step = hn::Lanes(lanes);
  const auto convert = [&](float* first, float* second) {
    const auto bearing_rad = hn::LoadU(lanes, first);
    const auto range_m = hn::LoadU(lanes, second);
    hn::StoreU(hn::Mul(range_m, hn::Cos(lanes, bearing_rad)), lanes, first);
    hn::StoreU(hn::Mul(range_m, hn::Sin(lanes, bearing_rad)), lanes, second);
  };
  std::size_t i = 0;
  for (; i + step <= count; i += step) convert(bearing_then_x + i, range_then_y + i);
  if (i == count) return;
  float first[8] = {};
  float second[8] = {};
  std::copy(bearing_then_x + i, bearing_then_x + count, first);
  std::copy(range_then_y + i, range_then_y + count, second);
  convert(first, second);
  std::copy(first, first + (count - i), bearing_then_x + i);
  std::copy(second, second + (count - i), range_then_y + i);
}

}  // namespace

void MatchPoints::Assign(const Scan& scan) {
  x_m.resize(scan.beams.size());
  y_m.resize(scan.beams.size());
  farthest_m = 0.0F;
  std::size_t count = 0;
  for (const Beam& beam : scan.beams) {
    const bool usable = beam.hit && beam.range_m > 0.0F && beam.range_m < kFarthestUsedM &&
                        std::abs(beam.bearing_rad) < kLargestBearingRad;
    x_m[count] = beam.bearing_rad;
    y_m[count] = beam.range_m;
    count += usable ? 1 : 0;
    farthest_m = usable ? std::max(farthest_m, beam.range_m) : farthest_m;
  }
  x_m.resize(count);
  y_m.resize(count);
  ToPoints(count, x_m.data(), y_m.data());
}

}  // namespace depthgrid
