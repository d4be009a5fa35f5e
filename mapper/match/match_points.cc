#include "mapper/match/match_points.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

// Farther than any laser sees: keeps cell indices of corrupt ranges within int.
constexpr float kFarthestUsedM = 1e4F;

}  // namespace

void MatchPoints::Assign(const Scan& scan) {
  x_m.clear();
  y_m.clear();
  x_m.reserve(scan.beams.size());
  y_m.reserve(scan.beams.size());
  farthest_m = 0.0F;
  for (const Beam& beam : scan.beams) {
    const bool usable = beam.hit && beam.range_m > 0.0F && beam.range_m < kFarthestUsedM &&
                        std::isfinite(beam.bearing_rad);
    if (!usable) continue;
    x_m.push_back(beam.range_m * std::cos(beam.bearing_rad));
    y_m.push_back(beam.range_m * std::sin(beam.bearing_rad));
    farthest_m = std::max(farthest_m, beam.range_m);
  }
}

}  // namespace depthgrid
