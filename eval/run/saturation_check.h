// Detects depth images clipped to a maximum by a simulator or driver, instead of marking farther
// pixels as invalid. Taken for walls, these pixels become arcs that move with the camera.
#pragma once

#include <optional>

#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

class SaturationCheck {
 public:
  void Add(const DepthImage& depth, const Pose3& world_from_camera);

  struct Saturation {
    float z_m = 0.0F;
    int frames = 0;
  };
  // The largest depth of all images, if in several of them at least 1 % of the pixels have it
  // although the camera turned: a wall does not have the same depth from two directions. Not where
  // about as many have the depth one step below, as of a camera whose depth comes in steps.
  std::optional<Saturation> Found() const;

 private:
  float largest_m_ = 0.0F;
  std::optional<Pose3> first_;  // first pose with so many such pixels
  bool turned_ = false;
  int frames_ = 0;
};

}  // namespace depthgrid
