// Settings of Eq. 3.
#pragma once

#include <array>

#include "mapper/core/options.h"

namespace depthgrid {

struct FusionOptions {
  // K of Eq. 3: the share of the innovation taken, per base axis (forward, left, yaw). All zero:
  // SLAM's poses are taken as they are and nothing is matched. All one: the matched pose whole.
  std::array<double, 3> gain = {0.0, 0.0, 0.0};

  bool TrustsSlamAlone() const { return gain == std::array<double, 3>{}; }
  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
