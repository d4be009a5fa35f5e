// A depth camera without noise: the z-depth of the nearest surface behind each pixel's centre.
#pragma once

#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"
#include "sim/depth/ray_scene.h"

namespace depthgrid {

// What noise models need besides the depth: how obliquely each pixel's ray meets the surface.
struct DepthFrame {
  DepthImage depth;
  std::vector<float> incidence_cos;  // |cos| of the angle between ray and normal; 0 without a hit
};

class DepthCamera {
 public:
  // `threads` only changes the speed; 1 is serial. Throws InputError for a camera with lens
  // distortion: rendered images are those of an ideal pinhole.
  DepthCamera(RayScene scene, const PinholeCamera& camera, int threads = 1);

  // The world seen from a pose. Pixels that see no surface are kInvalidDepth.
  DepthImage Render(const Pose3& world_from_camera) const;
  DepthFrame RenderWithIncidence(const Pose3& world_from_camera) const;

  const PinholeCamera& camera() const { return camera_; }

 private:
  void RenderInto(const Pose3& world_from_camera, DepthImage& depth, float* incidence_cos) const;

  RayScene scene_;
  PinholeCamera camera_;
  int threads_;
  std::vector<float> tangent_x_;  // of each column: x/z of its pixel centres, camera axes
  std::vector<float> tangent_y_;  // of each row; both padded to whole tiles
};

}  // namespace depthgrid
