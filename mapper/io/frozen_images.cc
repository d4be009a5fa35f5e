#include "mapper/io/frozen_images.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// A camera that records 15 images a second as 30 is told from a standing one from .35 m/s on.
constexpr double kStandsM = 0.01;
constexpr double kStandsRad = RadFromDeg(0.4);
constexpr double kDriftPerS = 5.0;  // times those

bool SeesSomething(const DepthImage& image) {
  return std::any_of(image.z_m.begin(), image.z_m.end(),
                     [](float z_m) { return z_m != kInvalidDepth && !std::isnan(z_m); });
}

// By their bits: some drivers write NaN for invalid pixels, which compares unequal to itself.
bool AreSame(const std::vector<float>& a, const std::vector<float>& b) {
  return !a.empty() && a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace

bool FrozenImages::IsFrozen(std::shared_ptr<const DepthImage> image, const Pose3& slam_from_camera,
                            double stamp_s, int slam_epoch) {
  const bool same = image_ && slam_epoch == slam_epoch_ && AreSame(image->z_m, image_->z_m) &&
                    SeesSomething(*image);
  if (!same) {
    image_ = std::move(image);
    slam_from_camera_ = slam_from_camera;
    stamp_s_ = stamp_s;
    slam_epoch_ = slam_epoch;
    return false;
  }
  const double seconds = std::max(stamp_s - stamp_s_, 0.0);
  const Pose3 motion = Inverse(slam_from_camera_) * slam_from_camera;
  const double times = 1.0 + kDriftPerS * seconds;
  return LogRotation(motion.rotation).norm() > times * kStandsRad ||
         std::abs(motion.translation.z()) > times * kStandsM;
}

}  // namespace depthgrid
