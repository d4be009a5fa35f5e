// Surface patches of depth images, for finding level surfaces. Internal to mapper/io.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

namespace internal {
// A small piece of surface in an image.
struct SurfacePatch {
  Eigen::Vector3d point;   // in the world
  Eigen::Vector3d normal;  // towards the camera
};
// The surface patches of one image.
struct SurfaceView {
  Eigen::Vector3d camera;  // its position
  std::vector<SurfacePatch> patches;
};

SurfaceView ViewOf(const DepthImage& image, const PinholeCamera& camera,
                   const Pose3& world_from_camera);

// The share of all patches whose height along `up` is below `height_m`.
double ShareBelow(const std::vector<SurfaceView>& views, const Eigen::Vector3d& up,
                  double height_m);
}  // namespace internal

}  // namespace depthgrid
