// The obstacle points of a scan, laid out for the matchers.
#pragma once

#include <vector>

#include "mapper/core/scan.h"

namespace depthgrid {

// One point per hit, in base axes and in the order of the beams. Single precision resolves a
// micrometre at 10 m.
struct MatchPoints {
  std::vector<float> x_m;
  std::vector<float> y_m;
  float farthest_m = 0.0F;  // largest distance of a point from base; 0 without points

  int size() const { return static_cast<int>(x_m.size()); }
  // Replaces the points by those of the scan, reusing memory. Beams whose bearing is not
  // within two turns or whose range is not in (0, 10 km) are left out.
  void Assign(const Scan& scan);
};

}  // namespace depthgrid
