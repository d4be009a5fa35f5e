#include "mapper/io/undistort.h"

#include <algorithm>
#include <cmath>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// As in the conversion to scans: depths within 3 % are one surface, up to 86 degrees of incidence.
constexpr float kOneSurfaceShare = 0.03F;

float DepthAt(const DepthImage& image, const Eigen::Vector2f& pixel) {
  const int nearest_u = static_cast<int>(std::lround(pixel.x()));
  const int nearest_v = static_cast<int>(std::lround(pixel.y()));
  if (nearest_u < 0 || nearest_v < 0 || nearest_u >= image.width_px ||
      nearest_v >= image.height_px) {
    return kInvalidDepth;
  }
  const int u = std::clamp(static_cast<int>(std::floor(pixel.x())), 0, image.width_px - 2);
  const int v = std::clamp(static_cast<int>(std::floor(pixel.y())), 0, image.height_px - 2);
  const float z00 = image.At(u, v), z10 = image.At(u + 1, v);
  const float z01 = image.At(u, v + 1), z11 = image.At(u + 1, v + 1);
  const float low = std::min({z00, z10, z01, z11});
  const float high = std::max({z00, z10, z01, z11});
  // No interpolation with infinities, whose difference would be NaN.
  if (!(low > 0.0F) || !std::isfinite(high) || high - low > kOneSurfaceShare * low) {
    return image.At(nearest_u, nearest_v);
  }
  const float a = std::clamp(pixel.x() - static_cast<float>(u), 0.0F, 1.0F);
  const float b = std::clamp(pixel.y() - static_cast<float>(v), 0.0F, 1.0F);
  return (1.0F - b) * ((1.0F - a) * z00 + a * z10) + b * ((1.0F - a) * z01 + a * z11);
}

}  // namespace

Eigen::Vector2d DistortedPixel(const PinholeCamera& camera, const Eigen::Vector2d& normalised) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = normalised.x();
  const double y = normalised.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
  const double yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
  return {camera.cx_px + camera.fx_px * xd, camera.cy_px + camera.fy_px * yd};
}

Undistorter::Undistorter(const PinholeCamera& camera) : camera_(camera) {
  Require(camera.width_px >= 2 && camera.height_px >= 2, "an image to undistort has 2x2 pixels");
  source_px_.reserve(static_cast<std::size_t>(camera.width_px) *
                     static_cast<std::size_t>(camera.height_px));
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector3d ray = Unproject(camera, u, v, 1.0);
      Eigen::Vector2f source = DistortedPixel(camera, ray.head<2>()).cast<float>();
      // Outside the calibrated area the distortion polynomial may diverge.
      if (!source.allFinite() || source.cwiseAbs().maxCoeff() > 1e6F) source.setConstant(-10.0F);
      source_px_.push_back(source);
    }
  }
}

PinholeCamera Undistorter::camera() const {
  PinholeCamera straight = camera_;
  straight.distortion.fill(0.0);
  return straight;
}

DepthImage Undistorter::Apply(const DepthImage& distorted) const {
  Require(distorted.width_px == camera_.width_px && distorted.height_px == camera_.height_px,
          "the image to undistort has the camera's size");
  DepthImage image(distorted.width_px, distorted.height_px);
  for (std::size_t i = 0; i < source_px_.size(); ++i) {
    image.z_m[i] = DepthAt(distorted, source_px_[i]);
  }
  return image;
}

}  // namespace depthgrid
