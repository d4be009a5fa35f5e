// The pinhole camera of Eq. 1 with plumb-bob distortion (Brown 1966, as ROS and OpenCV order it).
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace depthgrid {

// Limit on either side of an image, from any source.
constexpr int kMostImageSidePx = 16384;

// Pixel (u, v) has its centre at integer coordinates: column u covers [u - 0.5, u + 0.5).
// Defaults are ICL-NUIM's (640x480, fx 481.20, fy taken positive, see docs/conventions.md).
struct PinholeCamera {
  int width_px = 640;
  int height_px = 480;
  double fx_px = 481.20;
  double fy_px = 480.00;
  double cx_px = 319.5;
  double cy_px = 239.5;
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  // k1 k2 p1 p2 k3, in normalised coordinates

  bool HasDistortion() const { return distortion != std::array<double, 5>{}; }
  bool operator==(const PinholeCamera&) const = default;
};

// The point at z-depth `z_m` on the ray of pixel (u, v), in camera axes. Distortion is not undone
// here.
inline Eigen::Vector3d Unproject(const PinholeCamera& camera, double u_px, double v_px,
                                 double z_m) {
  return {z_m * (u_px - camera.cx_px) / camera.fx_px, z_m * (v_px - camera.cy_px) / camera.fy_px,
          z_m};
}

// The pixel of a point in front of the camera (z > 0). Distortion is not applied here.
inline Eigen::Vector2d Project(const PinholeCamera& camera,
                               const Eigen::Vector3d& point_in_camera) {
  return {camera.cx_px + camera.fx_px * point_in_camera.x() / point_in_camera.z(),
          camera.cy_px + camera.fy_px * point_in_camera.y() / point_in_camera.z()};
}

// Throws InputError naming `place` unless both sides have 1 to kMostImageSidePx pixels (with
// distortion at least 2), focal lengths are positive, the principal point lies within ten focal
// lengths of the image and everything is finite.
void Validate(const PinholeCamera& camera, const std::string& place);

}  // namespace depthgrid
