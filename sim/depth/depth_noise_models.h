// The noise models' formulas as published; z in metres, angles in radians, lengths in pixels where
// said. docs/sensors.md lists them. Single precision and plain arithmetic only, so that loops over
// them vectorise and give the same bits on every machine.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace depthgrid::noise {

// condition ? yes : no without a branch, so that loops vectorise; both values are computed.
inline float Select(bool condition, float yes, float no) {
  const std::uint32_t mask = 0U - static_cast<std::uint32_t>(condition);
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(yes) & mask) |
                              (std::bit_cast<std::uint32_t>(no) & ~mask));
}

// floor(x) for 0 <= x < 2^31; vectorises without instructions that set the rounding mode.
inline float Whole(float x) { return static_cast<float>(static_cast<std::int32_t>(x)); }

constexpr float kRightAngle = 1.57079632679F;

// acos on [0, 1] to 2e-7 rad (Abramowitz and Stegun, 4.4.46).
inline float Acos(float x) {
  float p = -0.0012624911F;
  p = p * x + 0.0066700901F;
  p = p * x - 0.0170881256F;
  p = p * x + 0.0308918810F;
  p = p * x - 0.0501743046F;
  p = p * x + 0.0889789874F;
  p = p * x - 0.2145988016F;
  p = p * x + 1.5707963050F;
  return std::sqrt(1.0F - x) * p;
}

// Lower bound of pi/2 - theta (rad): no model is meaningful in the last half degree.
constexpr float kLeastRest = 0.01F;

// theta / (pi/2 - theta), bounded.
inline float ObliqueRatio(float theta) { return theta / std::max(kRightAngle - theta, kLeastRest); }

// Nguyen, Izadi, Lovell, "Modeling Kinect sensor noise for improved 3D reconstruction and
// tracking", 3DIMPVT 2012: equations for the axial and lateral standard deviation of a Kinect v1.
inline float NguyenSigma(float z, float theta) {
  constexpr float kOblique = 1.04719755120F;  // 60 degrees
  const float frontal = 0.0012F + 0.0019F * (z - 0.4F) * (z - 0.4F);
  const float rest = std::max(kRightAngle - theta, kLeastRest);
  const float oblique = 0.0001F / std::sqrt(z) * (theta * theta) / (rest * rest);
  return frontal + Select(theta > kOblique, oblique, 0.0F);
}

inline float NguyenLateralSigmaPx(float theta) { return 0.8F + 0.035F * ObliqueRatio(theta); }

// Handa et al., "A benchmark for RGB-D visual odometry, 3D reconstruction and SLAM", ICRA 2014,
// after Barron and Malik, CVPR 2013. Z in cm: 35130 / floor(35130 / Z + N(0, 1/6^2) + 0.5), steps
// of an eighth of a pixel of disparity, 35130 = 8 f b. A widely copied port rounds instead of
// taking the floor and so measures too short, by 1.4 mm at 1 m and 22.6 mm at 4 m.
constexpr float kHandaStepsM = 351.30F;
constexpr float kHandaShiftPx = 0.5F;
constexpr float kHandaDisparitySigmaSteps = 1.0F / 6.0F;

inline float HandaDepth(float inverse_z, float noise_steps) {
  constexpr float kMostSteps = 1e6F;  // a third of a millimetre
  const float shifted = kHandaStepsM * inverse_z + noise_steps + 0.5F;
  const float steps = Whole(std::min(std::max(shifted, 0.0F), kMostSteps));
  return Select(steps >= 1.0F, kHandaStepsM / steps, 0.0F);
}

// Stereo: z = f B / disparity, whose subpixel error is 0.08 px (Intel, "Best known methods for
// tuning RealSense D400 depth cameras", RMS error formula), B = 50 mm.
inline float D435Sigma(float z, float focal_px) {
  constexpr float kSubpixelPx = 0.08F;
  constexpr float kBaselineM = 0.050F;
  return z * z * (kSubpixelPx / (focal_px * kBaselineM));
}

// Fankhauser et al., "Kinect v2 for mobile robot navigation: evaluation and modeling", ICAR 2015.
inline float KinectV2Sigma(float z, float theta) {
  const float ratio = ObliqueRatio(theta);
  const float sigma_mm =
      1.5F - 0.5F * z + 0.3F * z * z + 0.1F * (z * std::sqrt(z)) * (ratio * ratio);
  return 0.001F * sigma_mm;
}

// An Azure Kinect-like time-of-flight camera.
constexpr float kAzureShiftPx = 0.25F;
constexpr float kAzureEdgeStepM = 0.8F;  // pixels whose 3x3 neighbours differ by more are invalid

inline float AzureSigma(float z) { return 0.0005F + 0.001F * std::max(z - 0.5F, 0.0F); }

// Two pixels, and the surface that the first one shows.
struct PixelPair {
  float z;
  float z_other;
  float apart_px;
  float cosine;  // of the incidence at the first
  float focal_px;
};

// Whether there is a depth edge between the two: z_other cannot lie on the plane through the first
// at its incidence. On a plane 1/z is linear in pixel coordinates, with a relative slope of at most
// 1 / (f cos) per pixel; another 1 % allows for curved surfaces.
inline bool IsBreak(const PixelPair& pair) {
  constexpr float kSlack = 0.01F;
  const float bound = pair.apart_px / (pair.focal_px * std::max(pair.cosine, 0.02F)) + kSlack;
  return std::abs(pair.z - pair.z_other) > pair.z_other * bound;
}

}  // namespace depthgrid::noise
