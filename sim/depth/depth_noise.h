// Turns a clean rendered depth frame into what a real sensor would have measured (docs/sensors.md).
#pragma once

#include <cstdint>
#include <vector>

#include "mapper/core/camera.h"
#include "sim/depth/depth_camera.h"
#include "sim/depth/sensor_options.h"

namespace depthgrid {

class DepthNoise {
 public:
  // Noise for images of SensorCamera(options). `threads` only changes the speed. Throws InputError
  // if the range limits leave no depth.
  explicit DepthNoise(const SensorOptions& options, int threads = 1);

  // The measured image. The noise depends on (seed, frame, pixel) alone, not on threads or the
  // order of frames.
  DepthImage Apply(const DepthFrame& clean, std::uint64_t seed, std::uint32_t frame) const;

  // Whether Apply reads incidence_cos; if not, it may be empty.
  bool NeedsIncidence() const;

 private:
  void ClampRange(DepthImage& depth) const;
  // Standard normals for the axial noise, correlated over noise_correlation_px.
  std::vector<float> CorrelatedAxial(std::uint64_t seed, std::uint32_t frame) const;
  DepthImage AddNoise(const DepthImage& lit, const float* incidence_cos, std::uint64_t seed,
                      std::uint32_t frame) const;

  SensorOptions options_;
  PinholeCamera camera_;
  DepthRange range_;
  int threads_;
};

}  // namespace depthgrid
