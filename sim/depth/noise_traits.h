// What differs between the depth noise models, a model in one place; their formulas are in
// depth_noise_models.h.
#pragma once

#include <limits>

#include "sim/depth/depth_samples.h"
#include "sim/depth/sensor_options.h"

namespace depthgrid::noise {

// Where a pixel takes its depth from (depth_samples.h).
enum class Sampling { kInPlace, kAcrossEdges, kBetweenPixels };

// A block of pixels to measure.
struct Unmeasured {
  const DepthSamples& clean;
  const Values& theta;   // incidence
  const Values& normal;  // the draw along the ray
  float scale;           // of the standard deviation
  float focal_px;
};

struct NoiseTraits {
  DepthRange range = {};
  Sampling sampling = Sampling::kInPlace;
  float shift_px = 0.0F;  // kBetweenPixels: its standard deviation
  Values (*measure)(const Unmeasured& block) = nullptr;
  // Pixels at larger steps of depth are lost (DropEdges).
  float most_step_m = std::numeric_limits<float>::infinity();
};

NoiseTraits TraitsOf(DepthNoiseModel model);

}  // namespace depthgrid::noise
