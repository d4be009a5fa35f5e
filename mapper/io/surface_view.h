// Pieces of surface in a depth image, for what is level in a recording. Only for this folder's own
// files.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

namespace internal {
// A piece of surface as an image shows it.
struct SurfacePatch {
  Eigen::Vector3d point;   // in the world
  Eigen::Vector3d normal;  // towards the camera
};
// What an image shows.
struct SurfaceView {
  Eigen::Vector3d camera;  // its position
  std::vector<SurfacePatch> patches;
};

SurfaceView ViewOf(const DepthImage& image, const PinholeCamera& camera,
                   const Pose3& world_from_camera);

// Of all patches, those whose height along `up` is less than `height_m`.
double ShareBelow(const std::vector<SurfaceView>& views, const Eigen::Vector3d& up,
                  double height_m);
}  // namespace internal

}  // namespace depthgrid
