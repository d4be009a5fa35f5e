// The part of a bearing that the image shows to be free (docs/math.md, "Free space").
#pragma once

#include <optional>

#include "mapper/scan/scan_options.h"

namespace depthgrid {

// Slopes (height over horizontal distance) of rays of one bearing, lower first.
struct SlopeRange {
  float low = 0.0F;
  float high = 0.0F;
};

// Slopes of the rays of one bearing.
struct BearingView {
  std::optional<SlopeRange> seen;  // lowest and highest ray with a usable depth
  // The largest unseen gaps between them below and above the horizon.
  std::optional<SlopeRange> gap_below;
  std::optional<SlopeRange> gap_above;
};

struct Distances {
  double from_m = 0.0;
  double to_m = 0.0;
};

// The distances before `limit_m` (the hit, or the range limit) at which the rays reach down to the
// band's lower edge and leave no gap larger than max_gap_m inside the band. `camera_height_m` is
// above the floor. Empty (from >= to) when there are none.
Distances ClearInterval(const BearingView& view, double camera_height_m, double limit_m,
                        const ScanOptions& options);

// The same for a scan read like a laser's: free up to the limit or to where the highest ray leaves
// the band.
Distances LaserClearInterval(const BearingView& view, double camera_height_m, double limit_m,
                             const ScanOptions& options);

}  // namespace depthgrid
