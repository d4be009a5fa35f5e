#include "mapper/io/undistort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid {
namespace {

// TUM freiburg1.
PinholeCamera KinectCamera() {
  return {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
}

// The ray of a pixel of the distorted image, by fixed-point iteration.
Eigen::Vector2d RayOf(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  Eigen::Vector2d ray((pixel.x() - camera.cx_px) / camera.fx_px,
                      (pixel.y() - camera.cy_px) / camera.fy_px);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d error = DistortedPixel(camera, ray) - pixel;
    ray -= Eigen::Vector2d(error.x() / camera.fx_px, error.y() / camera.fy_px);
  }
  return ray;
}

TEST(Undistort, HandWorkedCoefficients) {
  PinholeCamera camera{100, 100, 100, 200, 50, 60, {}};
  const Eigen::Vector2d ray(0.5, 0.1);  // r^2 = 0.26
  EXPECT_TRUE(DistortedPixel(camera, ray).isApprox(Eigen::Vector2d(100, 80)));
  camera.distortion = {0.1, 0, 0, 0, 0};  // 1.026
  EXPECT_TRUE(DistortedPixel(camera, ray).isApprox(Eigen::Vector2d(101.3, 80.52)));
  camera.distortion = {0, 0, 0.1, 0, 0};  // x + 2 p1 x y, y + p1 (r^2 + 2 y^2)
  EXPECT_TRUE(DistortedPixel(camera, ray).isApprox(Eigen::Vector2d(101.0, 85.6)));
  camera.distortion = {0, 0, 0, 0.1, 0};  // x + p2 (r^2 + 2 x^2), y + 2 p2 x y
  EXPECT_TRUE(DistortedPixel(camera, ray).isApprox(Eigen::Vector2d(107.6, 82.0)));
}

TEST(Undistort, ATiltedPlaneIsAPlaneAgain) {
  const PinholeCamera camera = KinectCamera();
  // 1/z = 0.4 + 0.2 x + 0.1 y of the ray (x, y, 1).
  const auto depth_of = [](const Eigen::Vector2d& ray) {
    return 1.0 / (0.4 + 0.2 * ray.x() + 0.1 * ray.y());
  };
  DepthImage distorted(camera.width_px, camera.height_px);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      distorted.Row(v)[u] = static_cast<float>(depth_of(RayOf(camera, Eigen::Vector2d(u, v))));
    }
  }
  const Undistorter undistorter(camera);
  EXPECT_FALSE(undistorter.camera().HasDistortion());
  const DepthImage image = undistorter.Apply(distorted);
  int compared = 0;
  double worst_before_m = 0.0;
  for (int v = 0; v < camera.height_px; v += 7) {
    for (int u = 0; u < camera.width_px; u += 7) {
      // Up to half a pixel beyond the outer centres the border's depth is taken as it is.
      const Eigen::Vector2d source = DistortedPixel(camera, Unproject(camera, u, v, 1.0).head<2>());
      const bool inside = source.minCoeff() >= 0.0 && source.x() <= camera.width_px - 1 &&
                          source.y() <= camera.height_px - 1;
      if (!inside || image.At(u, v) == kInvalidDepth) continue;
      const double truth_m = depth_of(Unproject(undistorter.camera(), u, v, 1.0).head<2>());
      ASSERT_NEAR(image.At(u, v), truth_m, 0.001) << u << " " << v;
      worst_before_m = std::max(worst_before_m, std::abs(distorted.At(u, v) - truth_m));
      ++compared;
    }
  }
  EXPECT_GT(compared, 5500);
  EXPECT_GT(worst_before_m, 0.02);  // what is at stake
}

TEST(Undistort, EdgesAndHolesAreNotSmeared) {
  const PinholeCamera camera = KinectCamera();
  DepthImage distorted(camera.width_px, camera.height_px);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      distorted.Row(v)[u] = u < 300 ? 1.0F : u < 340 ? kInvalidDepth : 3.0F;
    }
  }
  int near = 0, far = 0, invalid = 0;
  for (const float z_m : Undistorter(camera).Apply(distorted).z_m) {
    near += z_m == 1.0F ? 1 : 0;
    far += std::abs(z_m - 3.0F) < 1e-5F ? 1 : 0;
    invalid += z_m == kInvalidDepth ? 1 : 0;
  }
  EXPECT_EQ(near + far + invalid, 640 * 480);
  EXPECT_GT(near, 100000);
  EXPECT_GT(far, 100000);
  EXPECT_GT(invalid, 15000);
}

TEST(Undistort, WhatIsInfinitelyFarStaysSo) {
  const PinholeCamera camera = KinectCamera();
  DepthImage distorted(camera.width_px, camera.height_px);
  std::fill(distorted.z_m.begin(), distorted.z_m.end(), std::numeric_limits<float>::infinity());
  int numbers = 0;
  for (const float z_m : Undistorter(camera).Apply(distorted).z_m) numbers += z_m == z_m ? 1 : 0;
  EXPECT_EQ(numbers, 640 * 480);
}

}  // namespace
}  // namespace depthgrid
