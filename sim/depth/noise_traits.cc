#include "sim/depth/noise_traits.h"

#include "mapper/core/error.h"
#include "sim/depth/depth_noise_models.h"

namespace depthgrid::noise {
namespace {

// z + sigma(z, theta) n
template <typename Sigma>
Values AddAxial(const Unmeasured& block, const Sigma& sigma) {
  Values measured;
  const float scale = block.scale;
  const Values& z = block.clean.z;
  for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
    measured[i] = z[i] + scale * sigma(z[i], block.theta[i]) * block.normal[i];
  }
  return measured;
}

Values MeasureExactly(const Unmeasured& block) { return block.clean.z; }

Values MeasureNguyen(const Unmeasured& block) { return AddAxial(block, NguyenSigma); }

Values MeasureHanda(const Unmeasured& block) {
  Values measured;
  const float sigma_steps = block.scale * kHandaDisparitySigmaSteps;
  for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
    measured[i] = HandaDepth(1.0F / block.clean.z[i], sigma_steps * block.normal[i]);
  }
  return measured;
}

Values MeasureD435(const Unmeasured& block) {
  return AddAxial(block,
                  [focal_px = block.focal_px](float z, float) { return D435Sigma(z, focal_px); });
}

Values MeasureKinectV2(const Unmeasured& block) { return AddAxial(block, KinectV2Sigma); }

Values MeasureAzure(const Unmeasured& block) {
  return AddAxial(block, [](float z, float) { return AzureSigma(z); });
}

}  // namespace

// Ranges are those of the manufacturers (docs/sensors.md); Handa's model has none.
NoiseTraits TraitsOf(DepthNoiseModel model) {
  switch (model) {
    case DepthNoiseModel::kNone:
      return {.measure = MeasureExactly};
    case DepthNoiseModel::kNguyen:
      return {.range = {0.4, 8.0}, .sampling = Sampling::kAcrossEdges, .measure = MeasureNguyen};
    case DepthNoiseModel::kHanda:
      return {
          .sampling = Sampling::kBetweenPixels, .shift_px = kHandaShiftPx, .measure = MeasureHanda};
    case DepthNoiseModel::kD435:
      return {.range = {0.2, 10.0}, .measure = MeasureD435};
    case DepthNoiseModel::kKinectV2:
      return {.range = {0.5, 4.5}, .measure = MeasureKinectV2};
    case DepthNoiseModel::kAzure:
      return {.range = {0.5, 3.86},
              .sampling = Sampling::kBetweenPixels,
              .shift_px = kAzureShiftPx,
              .measure = MeasureAzure,
              .most_step_m = kAzureEdgeStepM};
  }
  Broken("a noise model has its traits");
}

}  // namespace depthgrid::noise
