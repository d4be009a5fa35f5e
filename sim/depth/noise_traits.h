// The properties of each depth noise model; the formulas are in depth_noise_models.h.
#pragma once

#include <limits>

#include "sim/depth/depth_samples.h"
#include "sim/depth/sensor_options.h"

namespace depthgrid::noise {

// Where a pixel takes its depth from (depth_samples.h).
enum class Sampling { kInPlace, kAcrossEdges, kBetweenPixels };

// Input of a noise model for a block of pixels.
struct Unmeasured {
  const DepthSamples& clean;
  const Values& theta;   // incidence
  const Values& normal;  // standard normal of the axial noise
  float scale;           // of the standard deviation
  float focal_px;
};

struct NoiseTraits {
  DepthRange range = {};
  Sampling sampling = Sampling::kInPlace;
  float shift_px = 0.0F;  // kBetweenPixels: its standard deviation
  Values (*measure)(const Unmeasured& block) = nullptr;
  // Pixels at larger depth steps become invalid (DropEdges).
  float most_step_m = std::numeric_limits<float>::infinity();
};

NoiseTraits TraitsOf(DepthNoiseModel model);

}  // namespace depthgrid::noise
