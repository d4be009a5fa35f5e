// Depth images that hold one largest value wherever the room is farther: a simulator's or driver's
// cut. Taken for walls, its pixels are arcs that go along with the camera.
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
  // The largest depth of all images, where at least a hundredth of the pixels of several hold it
  // although the camera turned: no wall has one depth from two sides.
  std::optional<Saturation> Found() const;

 private:
  float largest_m_ = 0.0F;
  std::optional<Pose3> first_;  // that holds so much of it
  bool turned_ = false;
  int frames_ = 0;
};

}  // namespace depthgrid
