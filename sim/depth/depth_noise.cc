#include "sim/depth/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "sim/depth/correlated_normals.h"
#include "sim/depth/depth_noise_models.h"
#include "sim/depth/depth_samples.h"
#include "sim/depth/noise_traits.h"
#include "sim/depth/parallel_calls.h"
#include "sim/depth/sensor_artifacts.h"

namespace depthgrid {
namespace {

using noise::DepthSamples;
using noise::kAxial;
using noise::kGrazing;
using noise::NoiseTraits;
using noise::SampleSource;
using noise::Sampling;
using noise::Values;

std::size_t BlocksOf(std::size_t pixels) {
  return (pixels + kNormalBlockItems - 1) / kNormalBlockItems;
}

DepthSamples Sample(const NoiseTraits& traits, const SampleSource& source, std::size_t first,
                    std::size_t count, const NormalBlock& random, float scale) {
  switch (traits.sampling) {
    case Sampling::kInPlace:
      return SampleInPlace(source, first, count);
    case Sampling::kAcrossEdges:
      return SampleAcrossEdges(source, first, count, random, scale);
    case Sampling::kBetweenPixels:
      return SampleBetweenPixels(source, first, count, random, scale * traits.shift_px);
  }
  Broken("a pixel is sampled in one of the ways");
}

// Pixels beyond this incidence are lost; infinite for kNoGrazingLimitDeg, so that softness has no
// effect there.
float GrazingLimitRad(const SensorOptions& options) {
  if (options.grazing_limit_deg >= kNoGrazingLimitDeg) {
    return std::numeric_limits<float>::infinity();
  }
  return static_cast<float>(RadFromDeg(options.grazing_limit_deg));
}

std::vector<float> InverseOf(const DepthImage& depth) {
  std::vector<float> inverse(depth.z_m.size());
  for (std::size_t i = 0; i < inverse.size(); ++i) {
    inverse[i] = noise::Select(depth.z_m[i] > 0.0F, 1.0F / depth.z_m[i], 0.0F);
  }
  return inverse;
}

}  // namespace

DepthNoise::DepthNoise(const SensorOptions& options, int threads)
    : options_(options),
      camera_(SensorCamera(options)),
      range_(SensorRange(options)),
      threads_(threads) {
  Require(threads >= 1, "at least one thread");
}

bool DepthNoise::NeedsIncidence() const {
  return options_.noise != DepthNoiseModel::kNone || options_.flying_pixels > 0.0;
}

DepthImage DepthNoise::Apply(const DepthFrame& clean, std::uint64_t seed,
                             std::uint32_t frame) const {
  Require(clean.depth.width_px == camera_.width_px && clean.depth.height_px == camera_.height_px,
          "the image has the sensor's size");
  Require(!NeedsIncidence() || clean.incidence_cos.size() == clean.depth.z_m.size(),
          "a cosine a pixel");
  DepthImage lit = options_.flying_pixels > 0.0
                       ? WithFlyingPixels(clean, camera_, options_.flying_pixels, seed, frame)
                       : clean.depth;
  if (options_.shadow_baseline_m != 0.0) {
    CastProjectorShadow(lit, camera_, options_.shadow_baseline_m);
  }
  if (options_.noise == DepthNoiseModel::kNone) {
    ClampRange(lit);
    return lit;
  }
  DepthImage measured = AddNoise(lit, clean.incidence_cos.data(), seed, frame);
  const float most_step_m = noise::TraitsOf(options_.noise).most_step_m;
  if (std::isfinite(most_step_m)) DropEdges(lit, most_step_m, measured);
  return measured;
}

void DepthNoise::ClampRange(DepthImage& depth) const {
  const auto min_m = static_cast<float>(range_.min_m), max_m = static_cast<float>(range_.max_m);
  for (float& z : depth.z_m) z = z >= min_m && z <= max_m ? z : kInvalidDepth;
}

std::vector<float> DepthNoise::CorrelatedAxial(std::uint64_t seed, std::uint32_t frame) const {
  const auto width = static_cast<std::size_t>(camera_.width_px);
  const std::size_t pixels = width * static_cast<std::size_t>(camera_.height_px);
  std::vector<float> white(pixels);
  CallInParallel(BlocksOf(pixels), threads_, [&](std::size_t block) {
    const std::size_t first = block * kNormalBlockItems;
    NormalBlock random;
    FillNormals(seed, RandomStage::kDepthNoise, frame, static_cast<std::uint32_t>(first), random);
    std::copy_n(random.normals[kAxial].data(),
                std::min<std::size_t>(kNormalBlockItems, pixels - first), white.data() + first);
  });
  return Correlated(white, width, options_.noise_correlation_px, threads_);
}

DepthImage DepthNoise::AddNoise(const DepthImage& lit, const float* incidence_cos,
                                std::uint64_t seed, std::uint32_t frame) const {
  const NoiseTraits traits = noise::TraitsOf(options_.noise);
  const bool looks_between = traits.sampling == Sampling::kBetweenPixels;
  const SampleSource source{lit, incidence_cos,
                            looks_between ? InverseOf(lit) : std::vector<float>{},
                            static_cast<float>(std::min(camera_.fx_px, camera_.fy_px))};
  const auto scale = static_cast<float>(options_.noise_scale);
  const auto focal_px = static_cast<float>(camera_.fx_px);
  const auto min_m = static_cast<float>(range_.min_m), max_m = static_cast<float>(range_.max_m);
  const float limit_rad = GrazingLimitRad(options_);
  const auto softness_rad = static_cast<float>(RadFromDeg(options_.grazing_softness_deg));
  const std::size_t pixels = lit.z_m.size();
  DepthImage noisy(lit.width_px, lit.height_px);
  const std::vector<float> correlated_axial =
      options_.noise_correlation_px > 0.0 ? CorrelatedAxial(seed, frame) : std::vector<float>{};
  const auto add_to_block = [&](std::size_t block) {
    const std::size_t first = block * kNormalBlockItems;
    const std::size_t count = std::min<std::size_t>(kNormalBlockItems, pixels - first);
    NormalBlock random;
    FillNormals(seed, RandomStage::kDepthNoise, frame, static_cast<std::uint32_t>(first), random);
    if (!correlated_axial.empty()) {
      std::copy_n(correlated_axial.data() + first, count, random.normals[kAxial].data());
    }
    const DepthSamples clean = Sample(traits, source, first, count, random, scale);
    alignas(64) Values theta;
    for (std::size_t i = 0; i < kNormalBlockItems; ++i) theta[i] = noise::Acos(clean.cosine[i]);
    Values measured = traits.measure({clean, theta, random.normals[kAxial], scale, focal_px});
    for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
      const float z = measured[i];
      const bool is_kept = (clean.z[i] > 0.0F) & (z > 0.0F) & (z >= min_m) & (z <= max_m) &
                           (theta[i] <= limit_rad + softness_rad * random.normals[kGrazing][i]);
      measured[i] = noise::Select(is_kept, z, kInvalidDepth);
    }
    std::copy_n(measured.data(), count, noisy.z_m.data() + first);
  };
  CallInParallel(BlocksOf(pixels), threads_, add_to_block);
  return noisy;
}

}  // namespace depthgrid
