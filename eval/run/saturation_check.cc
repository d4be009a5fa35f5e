#include "eval/run/saturation_check.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Chosen, of no measurement; a cut value comes back to the last bit but for an image's units.
constexpr float kSameM = 1e-3F;
constexpr double kShare = 0.01;
constexpr double kTurnRad = RadFromDeg(10.0);
constexpr int kFewFrames = 10;

}  // namespace

void SaturationCheck::Add(const DepthImage& depth, const Pose3& world_from_camera) {
  float largest_m = 0.0F;
  for (const float z_m : depth.z_m) {
    if (z_m > largest_m && std::isfinite(z_m)) largest_m = z_m;
  }
  if (largest_m > largest_m_ + kSameM) {
    *this = {};
    largest_m_ = largest_m;
  }
  if (largest_m == 0.0F || largest_m < largest_m_ - kSameM) return;
  const auto held = std::count_if(depth.z_m.begin(), depth.z_m.end(), [&](float z_m) {
    return z_m >= largest_m_ - kSameM && std::isfinite(z_m);
  });
  if (static_cast<double>(held) < kShare * static_cast<double>(depth.z_m.size())) return;
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
