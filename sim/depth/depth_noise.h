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
  // for a range limit that leaves nothing.
  explicit DepthNoise(const SensorOptions& options, int threads = 1);

  // The measured image. Draws depend on (seed, frame, pixel) alone: neither threads nor the order
  // of frames changes them.
  DepthImage Apply(const DepthFrame& clean, std::uint64_t seed, std::uint32_t frame) const;

  // Whether Apply reads the frame's cosines; if not, they may be left out.
  bool NeedsIncidence() const;

 private:
  void ClampRange(DepthImage& depth) const;
  // The draws along the rays, alike over noise_correlation_px.
  std::vector<float> CorrelatedAxial(std::uint64_t seed, std::uint32_t frame) const;
  DepthImage AddNoise(const DepthImage& lit, const float* incidence_cos, std::uint64_t seed,
                      std::uint32_t frame) const;

  SensorOptions options_;
  PinholeCamera camera_;
  DepthRange range_;
  int threads_;
};

}  // namespace depthgrid
