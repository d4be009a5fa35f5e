// How much the beams of scans err, read from the scans themselves, whatever errors neighbouring
// beams share. (RangeNoise of mapper/surfel is learnt scan by scan, of beams far enough apart that
// they share little.)
#pragma once

#include <vector>

#include "mapper/core/scan.h"

namespace depthgrid {

// Standard deviation of a beam's range as a share of the range, by distance: a depth camera's grows
// with it, a laser's is often the same everywhere.
class BeamNoise {
 public:
  explicit BeamNoise(const std::vector<Scan>& scans);

  double Share(double range_m) const;

 private:
  std::vector<double> share_of_metre_;  // of ranges from i to i + 1 m; the last one of all beyond
};

}  // namespace depthgrid
