#include "mapper/scan/clear_interval.h"

#include <algorithm>
#include <limits>

namespace depthgrid {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Distances at which the height of the band's lower edge lies between the lowest and the highest
// ray: low <= rise / d <= high, where `rise_m` is the edge's height above the camera.
Distances WhereEdgeIsSeen(const SlopeRange& seen, double rise_m) {
  if (rise_m < 0.0) {  // the camera looks down on the edge
    if (seen.low >= 0.0F) return {};
    return {rise_m / seen.low, seen.high < 0.0F ? rise_m / seen.high : kNever};
  }
  if (seen.high <= 0.0F) return {};
  return {rise_m / seen.high, seen.low > 0.0F ? rise_m / seen.low : kNever};
}

// Distances at which a gap is taller than allowed and inside the band.
Distances WhereGapHides(const SlopeRange& gap, double camera_height_m, const ScanOptions& options) {
  double leaves_band_m = kNever;
  if (gap.high < 0.0F) leaves_band_m = (options.band_low_m - camera_height_m) / gap.high;
  if (gap.low > 0.0F) leaves_band_m = (options.band_high_m - camera_height_m) / gap.low;
  return {options.max_gap_m / (gap.high - gap.low), leaves_band_m};
}

// Removes `hidden` from `clear` and keeps the longer of the remaining parts.
Distances Without(const Distances& clear, const Distances& hidden) {
  if (hidden.from_m >= clear.to_m || hidden.to_m <= clear.from_m || hidden.from_m >= hidden.to_m) {
    return clear;
  }
  const Distances before{clear.from_m, hidden.from_m};
  const Distances after{hidden.to_m, clear.to_m};
  return before.to_m - before.from_m >= after.to_m - after.from_m ? before : after;
}

}  // namespace

Distances ClearInterval(const BearingView& view, double camera_height_m, double limit_m,
                        const ScanOptions& options) {
  if (!view.seen) return {};
  Distances clear = WhereEdgeIsSeen(*view.seen, options.band_low_m - camera_height_m);
  clear.to_m = std::min(clear.to_m, limit_m);
  for (const auto* gap : {&view.gap_below, &view.gap_above}) {
    if (*gap) clear = Without(clear, WhereGapHides(**gap, camera_height_m, options));
  }
  return clear.from_m < clear.to_m ? clear : Distances{};
}

Distances LaserClearInterval(const BearingView& view, double camera_height_m, double limit_m,
                             const ScanOptions& options) {
  if (!view.seen) return {};
  double to_m = limit_m;
  const double slope = view.seen->high;
  if (slope < 0.0) to_m = std::min(to_m, (options.band_low_m - camera_height_m) / slope);
  if (view.seen->low > 0.0F) {
    to_m = std::min(to_m, (options.band_high_m - camera_height_m) / view.seen->low);
  }
  return to_m > 0.0 ? Distances{0.0, to_m} : Distances{};
}

}  // namespace depthgrid
