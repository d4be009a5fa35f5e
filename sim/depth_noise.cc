#include "sim/depth_noise.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/core/normal_block.h"
#include "sim/depth_noise_models.h"
#include "sim/sensor_artifacts.h"

namespace depthgrid {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
using Values = std::array<float, kNormalBlockItems>;

struct Range {
  double min_m;
  double max_m;
};

// What the sensors' makers state; Handa's model has no limits of its own.
Range ModelRange(DepthNoiseModel model) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  switch (model) {
    case DepthNoiseModel::kNone:
    case DepthNoiseModel::kHanda:
      return {0.0, kUnlimited};
    case DepthNoiseModel::kNguyen:
      return {0.4, 8.0};
    case DepthNoiseModel::kD435:
      return {0.2, 10.0};
    case DepthNoiseModel::kKinectV2:
      return {0.5, 4.5};
    case DepthNoiseModel::kAzure:
      return {0.5, 3.86};
  }
  return {0.0, kUnlimited};
}

bool SamplesBetweenPixels(DepthNoiseModel model) {
  return model == DepthNoiseModel::kHanda || model == DepthNoiseModel::kAzure;
}

// One frame on its way through the model.
struct Source {
  const DepthImage& depth;
  const float* incidence_cos;
  std::vector<float> inverse_z;  // 1/z, 0 where invalid; only for models that sample between pixels
  std::vector<float> step_3x3_m;  // largest depth difference among 3x3 neighbours; only for kAzure
  float focal_px;
};

// Consecutive pixels of a frame.
struct Block {
  std::size_t first = 0;
  int count = 0;
  NormalBlock random;
  Values z;       // sampled clean depth; 0 is invalid
  Values cosine;  // of the incidence where it was sampled
  Values theta;   // its angle
  Values out;
};

// Calls f(i, u, v) for each of the block's pixels.
template <typename F>
void ForEachPixel(const Block& block, int width_px, const F& f) {
  const auto width = static_cast<std::size_t>(width_px);
  int u = static_cast<int>(block.first % width);
  int v = static_cast<int>(block.first / width);
  for (int i = 0; i < block.count; ++i) {
    f(static_cast<std::size_t>(i), u, v);
    if (++u == width_px) {
      u = 0;
      ++v;
    }
  }
}

void SampleInPlace(const Source& source, Block& block) {
  std::copy_n(source.depth.z_m.data() + block.first, block.count, block.z.data());
  std::copy_n(source.incidence_cos + block.first, block.count, block.cosine.data());
}

int RoundClamped(float x, int size) {
  return std::clamp(static_cast<int>(std::floor(x + 0.5F)), 0, size - 1);
}

// Nguyen's lateral error moves silhouettes. Within a surface the pixel keeps its own depth: the
// axial sigma was measured on planes and already holds what a shift does there.
void SampleAcrossEdges(const Source& source, float scale, Block& block) {
  const DepthImage& depth = source.depth;
  SampleInPlace(source, block);
  for (std::size_t i = 0; i < kNormalBlockItems; ++i) block.theta[i] = noise::Acos(block.cosine[i]);
  ForEachPixel(block, depth.width_px, [&](std::size_t i, int u, int v) {
    const float sigma_px = scale * noise::NguyenLateralSigma_px(block.theta[i]);
    const float du = sigma_px * block.random.normals[0][i];
    const float dv = sigma_px * block.random.normals[1][i];
    if (std::abs(du) < 0.5F && std::abs(dv) < 0.5F) return;
    const int other_u = RoundClamped(static_cast<float>(u) + du, depth.width_px);
    const int other_v = RoundClamped(static_cast<float>(v) + dv, depth.height_px);
    const float other_z = depth.At(other_u, other_v);
    const auto whole_u = static_cast<float>(other_u - u), whole_v = static_cast<float>(other_v - v);
    const float pixels = std::sqrt(whole_u * whole_u + whole_v * whole_v);
    const bool has_both = block.z[i] > 0.0F && other_z > 0.0F;
    if (has_both &&
        !noise::IsBreak(block.z[i], other_z, pixels, block.cosine[i], source.focal_px)) {
      return;
    }
    block.z[i] = other_z;
    block.cosine[i] =
        source.incidence_cos[static_cast<std::size_t>(other_v * depth.width_px + other_u)];
  });
}

// The depth at (u, v) shifted by a normal draw. Between pixels of one surface 1/z is interpolated,
// which is exact on planes; where the four pixels around are not one surface, the nearest is taken.
void SampleBetweenPixels(const Source& source, float sigma_px, Block& block) {
  const int width = source.depth.width_px, height = source.depth.height_px;
  const float* const inverse_z = source.inverse_z.data();
  ForEachPixel(block, width, [&](std::size_t i, int u, int v) {
    const float x = std::clamp(static_cast<float>(u) + sigma_px * block.random.normals[0][i], 0.0F,
                               static_cast<float>(width - 1));
    const float y = std::clamp(static_cast<float>(v) + sigma_px * block.random.normals[1][i], 0.0F,
                               static_cast<float>(height - 1));
    const int u0 = static_cast<int>(x), v0 = static_cast<int>(y);  // not negative: floor
    const float right = x - static_cast<float>(u0), down = y - static_cast<float>(v0);
    const int step_u = u0 + 1 < width ? 1 : 0, step_v = v0 + 1 < height ? width : 0;
    const int corner = v0 * width + u0;
    const int nearest = corner + (right >= 0.5F ? step_u : 0) + (down >= 0.5F ? step_v : 0);
    const float a = inverse_z[corner], b = inverse_z[corner + step_u];
    const float c = inverse_z[corner + step_v], d = inverse_z[corner + step_u + step_v];
    const float low = std::min(std::min(a, b), std::min(c, d));
    const float high = std::max(std::max(a, b), std::max(c, d));
    const float cosine = source.incidence_cos[nearest];
    constexpr float kDiagonal_px = 1.41421356F;
    const bool one_surface =
        low > 0.0F && !noise::IsBreak(high, low, kDiagonal_px, cosine, source.focal_px);
    const float top = a + right * (b - a), bottom = c + right * (d - c);
    block.cosine[i] = cosine;
    block.z[i] = one_surface ? 1.0F / (top + down * (bottom - top))
                             : (inverse_z[nearest] > 0.0F ? 1.0F / inverse_z[nearest] : 0.0F);
  });
}

// out = z + sigma(z, theta) n
template <typename Sigma>
void AddAxial(float scale, Block& block, const Sigma& sigma) {
  const Values& normal = block.random.normals[2];
  for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
    block.out[i] = block.z[i] + scale * sigma(block.z[i], block.theta[i]) * normal[i];
  }
}

void AddModelNoise(DepthNoiseModel model, float scale, float focal_px, Block& block) {
  const Values& normal = block.random.normals[2];
  switch (model) {
    case DepthNoiseModel::kNone:
      block.out = block.z;
      return;
    case DepthNoiseModel::kNguyen:
      return AddAxial(scale, block, noise::NguyenSigma);
    case DepthNoiseModel::kHanda:
      for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
        block.out[i] = noise::HandaDepth(1.0F / block.z[i],
                                         scale * noise::kHandaDisparitySigma_steps * normal[i]);
      }
      return;
    case DepthNoiseModel::kD435:
      return AddAxial(scale, block, [&](float z, float) { return noise::D435Sigma(z, focal_px); });
    case DepthNoiseModel::kKinectV2:
      return AddAxial(scale, block, noise::KinectV2Sigma);
    case DepthNoiseModel::kAzure:
      return AddAxial(scale, block, [](float z, float) { return noise::AzureSigma(z); });
  }
}

// The largest difference between depths in each pixel's 3x3 neighbourhood; invalid pixels count for
// nothing.
std::vector<float> Step3x3(const DepthImage& depth) {
  const int width = depth.width_px, height = depth.height_px;
  std::vector<float> low(depth.z_m.size()), high(depth.z_m.size()), step(depth.z_m.size());
  const auto or_far = [](float z) { return z > 0.0F ? z : kInfinity; };
  for (int v = 0; v < height; ++v) {
    const float* const row = depth.Row(v);
    const std::size_t at = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
    for (int u = 0; u < width; ++u) {
      const float left = row[std::max(u - 1, 0)], right = row[std::min(u + 1, width - 1)];
      low[at + static_cast<std::size_t>(u)] =
          std::min(std::min(or_far(left), or_far(right)), or_far(row[u]));
      high[at + static_cast<std::size_t>(u)] = std::max(std::max(left, right), row[u]);
    }
  }
  for (int v = 0; v < height; ++v) {
    const auto row_at = [&](int row) {
      return static_cast<std::size_t>(std::clamp(row, 0, height - 1)) *
             static_cast<std::size_t>(width);
    };
    const std::size_t above = row_at(v - 1), here = row_at(v), below = row_at(v + 1);
    for (std::size_t u = 0; u < static_cast<std::size_t>(width); ++u) {
      step[here + u] = std::max(std::max(high[above + u], high[below + u]), high[here + u]) -
                       std::min(std::min(low[above + u], low[below + u]), low[here + u]);
    }
  }
  return step;
}

std::vector<float> InverseOf(const DepthImage& depth) {
  std::vector<float> inverse(depth.z_m.size());
  std::transform(depth.z_m.begin(), depth.z_m.end(), inverse.begin(),
                 [](float z) { return z > 0.0F ? 1.0F / z : 0.0F; });
  return inverse;
}

}  // namespace

DepthNoise::DepthNoise(const SensorOptions& options, int threads)
    : options_(options), camera_(SensorCamera(options)), threads_(threads) {
  const Range range = ModelRange(options.noise);
  min_range_m_ = options.min_range_m > 0 ? options.min_range_m : range.min_m;
  max_range_m_ = options.max_range_m > 0 ? options.max_range_m : range.max_m;
  Require(threads >= 1, "at least one thread");
  if (min_range_m_ >= max_range_m_) {
    throw InputError("sensor", "min_range_m is " + std::to_string(min_range_m_) +
                                   ", must be below max_range_m, " + std::to_string(max_range_m_));
  }
}

bool DepthNoise::NeedsIncidence() const {
  return options_.noise != DepthNoiseModel::kNone || options_.flying_pixels > 0.0;
}

DepthImage DepthNoise::Apply(const DepthFrame& clean, std::uint64_t seed,
                             std::uint32_t frame) const {
  const std::size_t pixels = clean.depth.z_m.size();
  Require(clean.depth.width_px == camera_.width_px && clean.depth.height_px == camera_.height_px,
          "the image has the sensor's size");
  Require(!NeedsIncidence() || clean.incidence_cos.size() == pixels, "a cosine a pixel");
  const DepthNoiseModel model = options_.noise;
  DepthImage measured = options_.flying_pixels > 0.0
                            ? WithFlyingPixels(clean, camera_, options_.flying_pixels, seed, frame)
                            : clean.depth;
  if (options_.shadow_baseline_m != 0.0) {
    CastProjectorShadow(measured, camera_, options_.shadow_baseline_m);
  }
  const auto min_m = static_cast<float>(min_range_m_), max_m = static_cast<float>(max_range_m_);
  if (model == DepthNoiseModel::kNone) {
    for (float& z : measured.z_m) z = z >= min_m && z <= max_m ? z : kInvalidDepth;
    return measured;
  }

  const DepthImage before = measured;
  const Source source{before, clean.incidence_cos.data(),
                      SamplesBetweenPixels(model) ? InverseOf(before) : std::vector<float>{},
                      model == DepthNoiseModel::kAzure ? Step3x3(before) : std::vector<float>{},
                      static_cast<float>(std::min(camera_.fx_px, camera_.fy_px))};
  const auto scale = static_cast<float>(options_.noise_scale);
  const auto limit = static_cast<float>(RadFromDeg(options_.grazing_limit_deg));
  const auto softness = static_cast<float>(RadFromDeg(options_.grazing_softness_deg));
  const auto apply_block = [&](std::size_t index) {
    Block block;
    block.first = index * kNormalBlockItems;
    block.count = static_cast<int>(std::min<std::size_t>(kNormalBlockItems, pixels - block.first));
    block.z.fill(0.0F);
    block.cosine.fill(0.0F);
    FillNormals(seed, RandomStage::kDepthNoise, frame, static_cast<std::uint32_t>(block.first),
                block.random);
    if (model == DepthNoiseModel::kNguyen) {
      SampleAcrossEdges(source, scale, block);
    } else if (SamplesBetweenPixels(model)) {
      const float shift_px =
          model == DepthNoiseModel::kHanda ? noise::kHandaShift_px : noise::kAzureShift_px;
      SampleBetweenPixels(source, scale * shift_px, block);
    } else {
      SampleInPlace(source, block);
    }
    for (std::size_t i = 0; i < kNormalBlockItems; ++i) {
      block.theta[i] = noise::Acos(block.cosine[i]);
    }
    AddModelNoise(model, scale, static_cast<float>(camera_.fx_px), block);
    float* const out = measured.z_m.data() + block.first;
    const Values& soft = block.random.normals[3];
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i) {
      const float z = block.out[i];
      const bool kept = block.z[i] > 0.0F && z > 0.0F && z >= min_m && z <= max_m &&
                        block.theta[i] <= limit + softness * soft[i];
      out[i] = kept ? z : kInvalidDepth;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i) {
      if (model == DepthNoiseModel::kAzure &&
          source.step_3x3_m[block.first + i] > noise::kAzureEdgeStep_m) {
        out[i] = kInvalidDepth;
      }
    }
  };
  const std::size_t blocks = (pixels + kNormalBlockItems - 1) / kNormalBlockItems;
  if (threads_ == 1) {
    for (std::size_t index = 0; index < blocks; ++index) apply_block(index);
  } else {
    tbb::task_arena(threads_).execute(
        [&] { tbb::parallel_for(std::size_t{0}, blocks, apply_block); });
  }
  return measured;
}

}  // namespace depthgrid
