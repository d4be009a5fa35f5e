// Tremor of a hand that holds a camera: smooth, band-limited, and a function of seed and time
// alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mapper/core/pose3.h"

namespace depthgrid {

struct HandShakeOptions {
  double rotation_rms_rad = 0.0;   // about each camera axis
  double translation_rms_m = 0.0;  // along each camera axis
};

class HandShake {
 public:
  HandShake(const HandShakeOptions& options, std::uint64_t seed);
  // still_from_shaken at a time: the small motion of the camera in its own axes.
  Pose3 At(double time_s) const;

 private:
  struct Wave {
    double amplitude = 0.0;
    double angular_rate_rad_per_s = 0.0;
    double phase_rad = 0.0;
  };
  // Rotation about x, y, z, then shift along x, y, z.
  std::array<std::vector<Wave>, 6> waves_;
};

}  // namespace depthgrid
