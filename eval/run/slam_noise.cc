#include "eval/run/slam_noise.h"

#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// For one axis: variance of a single pose, and growth of the variance per second.
struct AxisNoise {
  double jitter2 = 0.0;
  double walk2_per_s = 0.0;
};

// The profile's sigmas of one axis: metres or radians, the drift per second.
struct AxisSigmas {
  double jitter = 0.0;
  double bias = 0.0;
  double walk = 0.0;
  double drift_rate = 0.0;
  double jump = 0.0;
};

AxisNoise AxisNoiseOf(const SlamOptions& slam, const AxisSigmas& sigmas) {
  const auto square = [](double value) { return value * value; };
  // Ornstein-Uhlenbeck: the variance of the integrated rate grows by 2 sigma^2 tau per second at
  // times beyond tau; that of the change of a bias by 2 sigma^2 / tau per second.
  const double walk2 = square(slam.drift_scale) *
                       (square(sigmas.walk) + 2.0 * square(sigmas.drift_rate) * slam.drift_time_s);
  return {square(sigmas.jitter), walk2 + 2.0 * square(sigmas.bias) / slam.bias_time_s +
                                     slam.jump_rate_hz * square(sigmas.jump)};
}

}  // namespace

SlamNoiseOptions NoiseOf(const SlamOptions& slam) {
  const AxisNoise shift = AxisNoiseOf(slam, {.jitter = slam.jitter_translation_m,
                                             .bias = slam.bias_translation_m,
                                             .walk = slam.walk_translation_m,
                                             .drift_rate = slam.drift_speed_mps,
                                             .jump = slam.jump_translation_m});
  const AxisNoise turn = AxisNoiseOf(slam, {.jitter = RadFromDeg(slam.jitter_rotation_deg),
                                            .bias = RadFromDeg(slam.bias_rotation_deg),
                                            .walk = RadFromDeg(slam.walk_rotation_deg),
                                            .drift_rate = RadFromDeg(slam.drift_turn_dps),
                                            .jump = RadFromDeg(slam.jump_rotation_deg)});
  // Rotation about the pivot shifts the camera sideways, not forward.
  const double pivot2 = 0.5 * slam.pivot_m * slam.pivot_m;
  SlamNoiseOptions noise;
  noise.source = SlamNoiseSource::kProfile;
  noise.jitter_m = std::sqrt(shift.jitter2 + pivot2 * turn.jitter2);
  noise.jitter_rad = std::sqrt(turn.jitter2);
  noise.walk_m_per_sqrt_s = std::sqrt(shift.walk2_per_s + pivot2 * turn.walk2_per_s);
  noise.walk_rad_per_sqrt_s = std::sqrt(turn.walk2_per_s);
  return noise;
}

}  // namespace depthgrid
