// Which way a recording's images are held.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "mapper/core/pose3.h"

namespace depthgrid {

class ImagesUp {
 public:
  void Add(const Pose3& world_from_camera) {
    ++count_;
    upward_ += world_from_camera.rotation * -Eigen::Vector3d::UnitY();
    sideways_ += std::abs((world_from_camera.rotation * Eigen::Vector3d::UnitX()).z());
  }
  // The mean of the images' upward directions, in the world, of no certain length; zero without
  // images. Of images held in portrait, which point upward in all directions as the camera turns
  // while z of the world stays beside them, it is z.
  Eigen::Vector3d Mean() const {
    // Images pitched by up to 37 degrees agree as well, whichever way the camera turns; those
    // pitched so in portrait have z beside them by more. Chosen, not measured.
    constexpr double kMostAgreement = 0.8, kLeastSideways = 0.75;
    const bool agree = upward_.norm() > kMostAgreement * count_;
    const bool lie_aside = sideways_ > kLeastSideways * count_;
    return !agree && lie_aside ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : upward_;
  }

 private:
  int count_ = 0;
  Eigen::Vector3d upward_ = Eigen::Vector3d::Zero();
  double sideways_ = 0.0;
};

}  // namespace depthgrid
