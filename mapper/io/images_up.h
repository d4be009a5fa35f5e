// Which way a recording's images are held.
#pragma once

#include <Eigen/Core>

#include "mapper/core/pose3.h"

namespace depthgrid {

class ImagesUp {
 public:
  void Add(const Pose3& world_from_camera);

  // About up in the world, of no certain length; zero without images. The mean of the images' own
  // upward directions where these agree. Elsewhere, if the camera turned, the direction to which
  // one axis of the images, x or in portrait y, stays square, however far the camera looks down. It
  // is portrait if that direction stays on one side of the images, and then z if z of the world
  // does.
  Eigen::Vector3d Mean() const;

 private:
  // Whether the direction stays on one side of the images, left or right.
  bool IsBeside(const Eigen::Vector3d& direction) const;

  int count_ = 0;
  Eigen::Vector3d upward_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d backward_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  // Sums of a a^T over the images' x and y axes.
  Eigen::Matrix3d x_scatter_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d y_scatter_ = Eigen::Matrix3d::Zero();
};

}  // namespace depthgrid
