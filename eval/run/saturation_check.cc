#include "eval/run/saturation_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Chosen, not measured. A clipped value is always the same, except for rounding to an image's
// units.
constexpr float kSameM = 1e-3F;
constexpr double kShare = 0.01;
constexpr double kTurnRad = RadFromDeg(10.0);
constexpr int kFewFrames = 10;
// A camera that measures disparity gives depth in steps, each with its share of a wall's pixels:
// 1.0 % of the depth at 3.5 m for a Kinect v1. What is cut lies on the last step instead of on all
// the farther ones, so that step has many times the pixels of the one below.
constexpr float kMostStep = 0.03F;
constexpr int kTimesTheStepBelow = 4;

// The largest finite value, 0 where none is greater. Runs over every pixel of every image: four
// independent maxima take a quarter of the time of one.
float LargestOf(const std::vector<float>& z_m) {
  float a = 0.0F, b = 0.0F, c = 0.0F, d = 0.0F;
  std::size_t i = 0;
  for (; i + 4 <= z_m.size(); i += 4) {
    a = z_m[i] > a ? z_m[i] : a;  // false for NaN
    b = z_m[i + 1] > b ? z_m[i + 1] : b;
    c = z_m[i + 2] > c ? z_m[i + 2] : c;
    d = z_m[i + 3] > d ? z_m[i + 3] : d;
  }
  for (; i < z_m.size(); ++i) a = z_m[i] > a ? z_m[i] : a;
  const float largest = std::max(std::max(a, b), std::max(c, d));
  if (std::isfinite(largest)) return largest;
  return std::accumulate(z_m.begin(), z_m.end(), 0.0F, [](float most, float z) {
    return z > most && std::isfinite(z) ? z : most;
  });
}

// How many pixels have the largest depth below `below_m`, if it is a step away at most.
long PixelsOfTheStepBelow(const std::vector<float>& z_m, float below_m) {
  const float least_m = (1.0F - kMostStep) * below_m;
  float next_m = least_m;
  for (const float z : z_m) next_m = z > next_m && z < below_m ? z : next_m;
  if (next_m == least_m) return 0;
  return std::count_if(z_m.begin(), z_m.end(),
                       [&](float z) { return z >= next_m - kSameM && z < below_m; });
}

}  // namespace

void SaturationCheck::Add(const DepthImage& depth, const Pose3& world_from_camera) {
  const float largest_m = LargestOf(depth.z_m);
  if (largest_m > largest_m_ + kSameM) {
    *this = {};
    largest_m_ = largest_m;
  }
  if (largest_m == 0.0F || largest_m < largest_m_ - kSameM) return;
  const auto held = std::count_if(depth.z_m.begin(), depth.z_m.end(), [&](float z_m) {
    return z_m >= largest_m_ - kSameM && std::isfinite(z_m);
  });
  if (static_cast<double>(held) < kShare * static_cast<double>(depth.z_m.size())) return;
  if (held < kTimesTheStepBelow * PixelsOfTheStepBelow(depth.z_m, largest_m_ - kSameM)) return;
  ++frames_;
  if (!first_) first_ = world_from_camera;
  const Pose3 motion = Inverse(*first_) * world_from_camera;
  turned_ = turned_ || LogRotation(motion.rotation).norm() > kTurnRad;
}

std::optional<SaturationCheck::Saturation> SaturationCheck::Found() const {
  if (!turned_ || frames_ < kFewFrames) return std::nullopt;
  return Saturation{largest_m_, frames_};
}

}  // namespace depthgrid
