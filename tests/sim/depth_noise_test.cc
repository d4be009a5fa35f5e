#include "sim/depth/depth_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "tests/sim/test_frames.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid {
namespace {

using test::Constant;
using test::Options;
using test::PlaneFrame;

struct Moments {
  double mean = 0.0;
  double sigma = 0.0;
  double count = 0.0;
};

// Of measured minus clean, over the pixels that were measured.
Moments ErrorsOf(const DepthImage& measured, const DepthImage& clean) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < measured.z_m.size(); ++i) {
    if (measured.z_m[i] <= 0.0F) continue;
    const double error = double{measured.z_m[i]} - double{clean.z_m[i]};
    sum += error;
    squares += error * error;
    ++count;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean), count};
}

void ExpectNormalErrors(const Moments& seen, double sigma) {
  EXPECT_GE(seen.count, 1e5);
  EXPECT_NEAR(seen.mean, 0.0, 4.0 * sigma / std::sqrt(seen.count));
  EXPECT_NEAR(seen.sigma, sigma, 4.0 * sigma / std::sqrt(2.0 * seen.count));
}

// Formulas as in docs/sensors.md, written out once more.
double SigmaOf(DepthNoiseModel model, double z, double theta) {
  switch (model) {
    case DepthNoiseModel::kNguyen: {
      const double frontal = 0.0012 + 0.0019 * std::pow(z - 0.4, 2);
      const double oblique = 0.0001 / std::sqrt(z) * theta * theta / std::pow(kPi / 2 - theta, 2);
      return theta > RadFromDeg(60.0) ? frontal + oblique : frontal;
    }
    case DepthNoiseModel::kD435:
      return z * z * 0.08 / (481.20 * 0.05);
    case DepthNoiseModel::kKinectV2:
      return 1e-3 * (1.5 - 0.5 * z + 0.3 * z * z +
                     0.1 * std::pow(z, 1.5) * std::pow(theta / (kPi / 2 - theta), 2));
    case DepthNoiseModel::kAzure:
      return 0.0005 + 0.001 * std::max(z - 0.5, 0.0);
    case DepthNoiseModel::kNone:
    case DepthNoiseModel::kHanda:  // steps of disparity: HandaNoise
      break;
  }
  return 0.0;
}

TEST(DepthNoise, SigmasAreTheDeclaredOnes) {
  for (const auto& [model, name] : kDepthNoiseModels) {
    if (SigmaOf(model, 1.0, 0.0) == 0.0) continue;
    const DepthNoise noise(Options(model));
    for (const double z : {0.8, 1.0, 2.0, 3.5}) {
      for (const double incidence_deg : {0.0, 30.0, 65.0, 80.0}) {
        SCOPED_TRACE(testing::Message() << name << " z " << z << " incidence " << incidence_deg);
        const DepthFrame clean = Constant(z, incidence_deg);
        ExpectNormalErrors(ErrorsOf(noise.Apply(clean, 5, 7), clean.depth),
                           SigmaOf(model, z, RadFromDeg(incidence_deg)));
      }
    }
  }
}

TEST(DepthNoise, SigmasAgreeWithThePublishedFigures) {
  // Millimetres at 1, 2 and 4 m, frontal.
  struct Row {
    DepthNoiseModel model;
    double mm[3];
  };
  for (const Row& row : {Row{DepthNoiseModel::kNguyen, {1.9, 6.1, 25.8}},
                         Row{DepthNoiseModel::kD435, {3.8, 15.1, 60.4}},
                         Row{DepthNoiseModel::kKinectV2, {1.3, 1.7, 4.3}}}) {
    SensorOptions options = Options(row.model);
    if (row.model == DepthNoiseModel::kD435)
      options.hfov_deg = DegFromRad(2 * std::atan(320. / 424));
    const DepthNoise noise(options);
    for (int k = 0; k < 3; ++k) {
      const DepthFrame clean = Constant(1 << k, 0.0);
      EXPECT_NEAR(1e3 * ErrorsOf(noise.Apply(clean, 1, 1), clean.depth).sigma, row.mm[k],
                  0.05 + 0.01 * row.mm[k]);
    }
  }
}

// Correlation exp(-(d / L)^2 / 2) along rows and columns, the declared sigma everywhere.
TEST(DepthNoise, NeighboursErrAlikeAsFarAsAsked) {
  const DepthFrame clean = Constant(2.0, 0.0);
  SensorOptions options = Options(DepthNoiseModel::kD435);
  const double sigma = ErrorsOf(DepthNoise(options).Apply(clean, 1, 0), clean.depth).sigma;
  options.noise_correlation_px = 4.0;
  double square = 0.0, edge = 0.0, along = 0.0, down = 0.0, far = 0.0;
  constexpr int kFrames = 40;
  constexpr int kApart = 4;
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    const DepthImage image = DepthNoise(options).Apply(clean, 1, frame);
    const auto error = [&](int u, int v) { return double{image.At(u, v)} - 2.0; };
    double count = 0.0, edge_count = 0.0;
    double squares = 0.0, edges = 0.0, alongs = 0.0, downs = 0.0, fars = 0.0;
    for (int v = 0; v + 6 * kApart < image.height_px; ++v) {
      edges += error(0, v) * error(0, v);
      ++edge_count;
      for (int u = 0; u + 6 * kApart < image.width_px; ++u) {
        squares += error(u, v) * error(u, v);
        alongs += error(u, v) * error(u + kApart, v);
        downs += error(u, v) * error(u, v + kApart);
        fars += error(u, v) * error(u + 6 * kApart, v);
        ++count;
      }
    }
    square += squares / count / kFrames;
    edge += edges / edge_count / kFrames;
    along += alongs / count / kFrames;
    down += downs / count / kFrames;
    far += fars / count / kFrames;
  }
  EXPECT_NEAR(std::sqrt(square), sigma, 0.01 * sigma);
  EXPECT_NEAR(std::sqrt(edge), sigma, 0.05 * sigma);
  EXPECT_NEAR(along / square, std::exp(-0.5), 0.02);
  EXPECT_NEAR(down / square, std::exp(-0.5), 0.02);
  EXPECT_NEAR(far / square, 0.0, 0.02);
}

TEST(DepthNoise, NoiseScaleMultipliesSigma) {
  SensorOptions options = Options(DepthNoiseModel::kD435);
  options.noise_scale = 3.0;
  const DepthFrame clean = Constant(2.0, 0.0);
  ExpectNormalErrors(ErrorsOf(DepthNoise(options).Apply(clean, 1, 1), clean.depth),
                     3.0 * 4.0 * 0.08 / (481.20 * 0.05));
}

TEST(HandaNoise, FollowsItsFormulaStepByStep) {
  // At one depth the outcome is a few disparity steps, with probabilities from the normal integral.
  const DepthNoise noise(Options(DepthNoiseModel::kHanda));
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  for (const double z : {0.83, 1.0, 2.1, 3.3, 4.0}) {
    const DepthFrame clean = Constant(z, 0.0);
    const DepthImage measured = noise.Apply(clean, 3, 0);
    const double disparity = 351.30 / static_cast<double>(static_cast<float>(z));
    double covered = 0.0;
    for (int k = static_cast<int>(disparity) - 1; k <= static_cast<int>(disparity) + 2; ++k) {
      const double expected = below(6 * (k + 0.5 - disparity)) - below(6 * (k - 0.5 - disparity));
      const double step_m = 351.30 / k;
      const auto seen =
          static_cast<double>(std::count_if(measured.z_m.begin(), measured.z_m.end(),
                                            [&](float m) { return std::abs(m - step_m) < 1e-5; }));
      const double n = 640 * 480;
      EXPECT_NEAR(seen / n, expected, 4 * std::sqrt(expected / n) + 1e-5) << z << " step " << k;
      covered += seen;
    }
    EXPECT_EQ(covered, 640 * 480);
  }
}

TEST(HandaNoise, HasNoBias) {
  // Slightly turned planes pass through many disparity steps. The port that rounds where the paper
  // takes the floor would measure short by 1.4, 5.8, 12.7 and 22.6 mm.
  const DepthNoise noise(Options(DepthNoiseModel::kHanda));
  for (const double z : {1.0, 2.0, 3.0, 4.0}) {
    const DepthFrame clean = PlaneFrame(z, 20.0);
    const Moments errors = ErrorsOf(noise.Apply(clean, 3, 0), clean.depth);
    EXPECT_GE(errors.count, 3e5);
    // What is left is the curvature of 1/x: mean of sigma^2/z, 0.1 mm at 4 m.
    EXPECT_NEAR(errors.mean, 0.0, 1e-4 + 1e-5 * z * z) << z;
  }
}

TEST(HandaNoise, SpreadsAsItsThreeSourcesTogether) {
  // Disparity: N(0, (1/6)^2), rounding 1/12, and the shift of half a pixel along the plane's slope.
  const DepthNoise noise(Options(DepthNoiseModel::kHanda));
  for (const double z : {1.0, 2.5, 4.0}) {
    for (const double turn_deg : {15.0, 40.0, 60.0}) {
      const DepthFrame clean = PlaneFrame(z, turn_deg);
      const DepthImage measured = noise.Apply(clean, 4, 1);
      // 1/z = (1 + tan(turn) x) / distance: in steps of disparity, so many a pixel.
      const double slope = 351.30 / z * std::tan(RadFromDeg(turn_deg)) / 481.20;
      const double sigma = std::sqrt(1.0 / 36 + 1.0 / 12 + 0.25 * slope * slope);
      double sum = 0.0, squares = 0.0, count = 0.0;
      for (int v = 10; v < 470; ++v) {  // at the border shifted samples are clamped
        for (int u = 10; u < 630; ++u) {
          const float m = measured.At(u, v);
          if (m <= 0.0F) continue;
          const double error = 351.30 / m - 351.30 / clean.depth.At(u, v);
          sum += error;
          squares += error * error;
          ++count;
        }
      }
      EXPECT_GE(count, 1e5);
      EXPECT_NEAR(std::sqrt(squares / count), sigma, 0.01 * sigma) << z << " " << turn_deg;
      EXPECT_NEAR(sum / count, 0.0, 5 * sigma / std::sqrt(count)) << z << " " << turn_deg;
    }
  }
}

// Near on the left half, far on the right.
DepthFrame Step(float near_m, float far_m, int width_px = 640) {
  DepthFrame frame{DepthImage(width_px, 480), {}};
  frame.depth.z_m.assign(frame.depth.z_m.size(), far_m);
  frame.incidence_cos.assign(frame.depth.z_m.size(), 1.0F);
  for (int v = 0; v < 480; ++v) std::fill_n(frame.depth.Row(v), width_px / 2, near_m);
  return frame;
}

// How far pixels look aside.
double LateralSigmaPx(DepthNoiseModel model) {
  switch (model) {
    case DepthNoiseModel::kNone:
    case DepthNoiseModel::kD435:
    case DepthNoiseModel::kKinectV2:
      return 0.0;
    case DepthNoiseModel::kNguyen:
      return 0.8;
    case DepthNoiseModel::kHanda:
      return 0.5;
    case DepthNoiseModel::kAzure:
      return 0.25;
  }
  return 0.0;
}

TEST(DepthNoise, LateralNoiseMovesSilhouettes) {
  // A pixel takes the other side when its shift exceeds the way to the edge, which lies half a
  // pixel before the first far column.
  constexpr int kWidth = 16, kFrames = 200;
  const auto below = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  std::vector<std::pair<DepthNoiseModel, float>> cases;
  // Azure would lose steps above 0.8 m.
  for (const auto& [model, name] : kDepthNoiseModels) cases.emplace_back(model, 2.6F);
  // Rays that meet nothing have no incidence: the silhouette is blurred as against anything.
  cases.emplace_back(DepthNoiseModel::kNguyen, kInvalidDepth);
  for (const auto& [model, far_m] : cases) {
    const double sigma_px = LateralSigmaPx(model);
    SCOPED_TRACE(testing::Message() << static_cast<int>(model) << " " << far_m);
    DepthFrame clean = Step(2.0F, far_m, kWidth);
    for (std::size_t i = 0; i < clean.depth.z_m.size(); ++i) {
      if (clean.depth.z_m[i] == kInvalidDepth) clean.incidence_cos[i] = 0.0F;
    }
    SensorOptions options = Options(model);
    options.width_px = kWidth;
    options.hfov_deg = 2.0;
    const DepthNoise noise(options);
    std::array<double, kWidth> crossed{};
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      const DepthImage measured = noise.Apply(clean, 1, frame);
      for (int v = 0; v < 480; ++v) {
        for (int u = 0; u < kWidth; ++u) {
          const bool is_far = measured.At(u, v) > 2.3F || measured.At(u, v) == kInvalidDepth;
          crossed[static_cast<std::size_t>(u)] += is_far != (u >= kWidth / 2) ? 1.0 : 0.0;
        }
      }
    }
    for (int u = 0; u < kWidth; ++u) {
      const double expected = below(-std::abs(u - (kWidth / 2 - 0.5)) / sigma_px);
      const double total = 480.0 * kFrames;
      EXPECT_NEAR(crossed[static_cast<std::size_t>(u)] / total, expected,
                  5 * std::sqrt(expected / total) + 1e-4)
          << u;
    }
  }
}

TEST(DepthNoise, NoDepthLiesBetweenTwoSurfacesUnlessAsked) {
  const DepthFrame clean = Step(1.0F, 3.0F);
  const auto between = [](const DepthImage& image) {
    return std::count_if(image.z_m.begin(), image.z_m.end(),
                         [](float z) { return z > 1.2F && z < 2.7F; });
  };
  for (const DepthNoiseModel model :
       {DepthNoiseModel::kNguyen, DepthNoiseModel::kHanda, DepthNoiseModel::kKinectV2}) {
    SensorOptions options = Options(model);
    EXPECT_EQ(between(DepthNoise(options).Apply(clean, 1, 0)), 0);
    options.flying_pixels = 0.5;
    // Two columns of 480 pixels, half of them flying, uniform over 2 m.
    EXPECT_NEAR(static_cast<double>(between(DepthNoise(options).Apply(clean, 1, 0))),
                2 * 480 * 0.5 * 0.75, 80.0);
  }
}

TEST(DepthNoise, RangeLimitsInvalidate) {
  SensorOptions options = Options(DepthNoiseModel::kNone);
  options.min_range_m = 1.0;
  options.max_range_m = 3.0;
  for (const auto& [z, kept] : {std::pair{0.99, false}, {1.0, true}, {3.0, true}, {3.01, false}}) {
    const DepthImage image = DepthNoise(options).Apply(Constant(z, 0.0), 1, 0);
    EXPECT_EQ(image.z_m[1234] > 0.0F, kept) << z;
  }
  // Models bring their own limits; measured depths decide.
  const DepthImage far =
      DepthNoise(Options(DepthNoiseModel::kKinectV2)).Apply(Constant(4.5, 0), 1, 0);
  const auto valid = std::count_if(far.z_m.begin(), far.z_m.end(), [](float z) { return z > 0; });
  EXPECT_NEAR(static_cast<double>(valid), 640 * 480 / 2, 2000);
  options.min_range_m = 4.0;
  EXPECT_THROW(DepthNoise{options}, InputError);
}

TEST(DepthNoise, GrazingPixelsAreLost) {
  SensorOptions options = Options(DepthNoiseModel::kHanda);
  const auto kept_share = [&](double incidence_deg) {
    const DepthImage image = DepthNoise(options).Apply(Constant(2.0, incidence_deg), 1, 0);
    return static_cast<double>(std::count_if(image.z_m.begin(), image.z_m.end(),
                                             [](float z) { return z > 0.0F; })) /
           static_cast<double>(image.z_m.size());
  };
  EXPECT_EQ(kept_share(81.9), 1.0);
  EXPECT_EQ(kept_share(82.1), 0.0);
  options.grazing_limit_deg = 70.0;
  options.grazing_softness_deg = 5.0;
  EXPECT_NEAR(kept_share(70.0), 0.5, 0.005);
  EXPECT_NEAR(kept_share(65.0), 0.8413, 0.005);
  EXPECT_NEAR(kept_share(80.0), 0.0228, 0.005);
  options.grazing_limit_deg = kNoGrazingLimitDeg;
  options.grazing_softness_deg = 30.0;
  EXPECT_EQ(kept_share(80.0), 1.0);
}

TEST(DepthNoise, WhatWasNotSeenStaysUnseen) {
  const DepthFrame nothing = Constant(0.0, 90.0);
  for (const auto& [model, name] : kDepthNoiseModels) {
    const DepthImage image = DepthNoise(Options(model)).Apply(nothing, 1, 0);
    for (const float z : image.z_m) ASSERT_EQ(z, kInvalidDepth);
  }
}

TEST(DepthNoise, DependsOnSeedFrameAndPixelAlone) {
  const DepthFrame clean = DepthCamera(RayScene(test::ClutteredRoom(5000)), PinholeCamera{})
                               .RenderWithIncidence(CameraOf({2.0, 2.0, 0.4}, 1.15));
  for (const auto& [model, name] : kDepthNoiseModels) {
    if (model == DepthNoiseModel::kNone) continue;
    SCOPED_TRACE(name);
    const DepthImage once = DepthNoise(Options(model)).Apply(clean, 1, 2);
    EXPECT_EQ(DepthNoise(Options(model)).Apply(clean, 1, 2).z_m, once.z_m);
    EXPECT_EQ(DepthNoise(Options(model), 2).Apply(clean, 1, 2).z_m, once.z_m);
    EXPECT_EQ(DepthNoise(Options(model), 3).Apply(clean, 1, 2).z_m, once.z_m);
    EXPECT_NE(DepthNoise(Options(model)).Apply(clean, 1, 3).z_m, once.z_m);
    EXPECT_NE(DepthNoise(Options(model)).Apply(clean, 2, 2).z_m, once.z_m);
    SensorOptions alike = Options(model);
    alike.noise_correlation_px = 3.0;
    const DepthImage smooth = DepthNoise(alike).Apply(clean, 1, 2);
    EXPECT_NE(smooth.z_m, once.z_m);
    EXPECT_EQ(DepthNoise(alike, 3).Apply(clean, 1, 2).z_m, smooth.z_m);
    alike.noise_correlation_px = 1e-200;  // no neighbours
    EXPECT_EQ(DepthNoise(alike).Apply(clean, 1, 2).z_m, once.z_m);
  }
}

TEST(DepthNoise, WorksAtAnySize) {
  for (const auto& [width, height] : {std::pair{2, 2}, {541, 361}, {3, 200}}) {
    for (const auto& [model, name] : kDepthNoiseModels) {
      SensorOptions options = Options(model);
      options.width_px = width;
      options.height_px = height;
      options.fx_px = options.fy_px = 481.2;
      DepthFrame clean{DepthImage(width, height), {}};
      clean.depth.z_m.assign(clean.depth.z_m.size(), 2.0F);
      clean.incidence_cos.assign(clean.depth.z_m.size(), 1.0F);
      const DepthImage measured = DepthNoise(options).Apply(clean, 1, 0);
      ASSERT_EQ(measured.z_m.size(), clean.depth.z_m.size());
      for (const float z : measured.z_m) ASSERT_NEAR(z, 2.0F, 0.1F) << name;
    }
  }
}

TEST(DepthNoise, AzureLosesDeepEdges) {
  const DepthNoise noise(Options(DepthNoiseModel::kAzure));
  const DepthImage deep = noise.Apply(Step(1.0F, 1.9F), 1, 0);
  const DepthImage shallow = noise.Apply(Step(1.0F, 1.7F), 1, 0);
  for (int v = 0; v < 480; ++v) {
    for (int u = 316; u < 324; ++u) {
      ASSERT_EQ(deep.At(u, v) > 0.0F, u != 319 && u != 320) << u;
      ASSERT_GT(shallow.At(u, v), 0.0F);
    }
  }
}

}  // namespace
}  // namespace depthgrid
