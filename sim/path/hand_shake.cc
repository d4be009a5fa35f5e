#include "sim/path/hand_shake.h"

#include <cmath>

#include "mapper/core/rng.h"

namespace depthgrid {
namespace {

// Sway and slow tremor, which a 30 Hz camera samples without aliasing. Physiological tremor (8-12
// Hz) is an order of magnitude smaller and left out.
constexpr double kLowestHz = 0.3;
constexpr double kHighestHz = 4.0;
constexpr int kWaves = 16;

}  // namespace

HandShake::HandShake(const HandShakeOptions& options, std::uint64_t seed) {
  for (std::size_t axis = 0; axis < waves_.size(); ++axis) {
    const double rms = axis < 3 ? options.rotation_rms_rad : options.translation_rms_m;
    if (rms == 0.0) continue;
    RandomStream random(seed, RandomStage::kTrajectory, static_cast<std::uint32_t>(axis));
    double power = 0.0;
    for (int i = 0; i < kWaves; ++i) {
      // One wave in each of equal bands of log frequency, amplitude 1/f: most of it is slow sway.
      const double share = (i + random.Uniform()) / kWaves;
      const double frequency_hz = kLowestHz * std::pow(kHighestHz / kLowestHz, share);
      const double amplitude = kLowestHz / frequency_hz;
      waves_[axis].push_back({amplitude, 2.0 * kPi * frequency_hz, random.Uniform(0.0, 2.0 * kPi)});
      power += 0.5 * amplitude * amplitude;
    }
    for (Wave& wave : waves_[axis]) wave.amplitude *= rms / std::sqrt(power);
  }
}

Pose3 HandShake::At(double time_s) const {
  std::array<double, 6> offset{};
  for (std::size_t axis = 0; axis < waves_.size(); ++axis) {
    for (const Wave& wave : waves_[axis]) {
      offset[axis] +=
          wave.amplitude * std::sin(wave.angular_rate_rad_per_s * time_s + wave.phase_rad);
    }
  }
  return {ExpRotation({offset[0], offset[1], offset[2]}), {offset[3], offset[4], offset[5]}};
}

}  // namespace depthgrid
