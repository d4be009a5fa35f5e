// Depth images that a driver gave again and again while the camera went on: they would be drawn,
// and matched, where nothing of it is.
#pragma once

#include <memory>

#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

class FrozenImages {
 public:
  // Whether the image is the same to the last pixel as those before it, since the first of which
  // the camera turned or went ahead: by more than 2 degrees or 5 cm, and as much for each second,
  // which a SLAM that wanders while its camera stands does not do. A camera that moves sideways
  // along a wall may see the same without noise. Asked for every image that has a pose, in the
  // order of time; the number changes where poses before and after cannot be compared.
  bool IsFrozen(std::shared_ptr<const DepthImage> image, const Pose3& slam_from_camera,
                double stamp_s, int slam_epoch);

 private:
  std::shared_ptr<const DepthImage> image_;  // the newest that was another than the one before
  Pose3 slam_from_camera_;
  double stamp_s_ = 0.0;
  int slam_epoch_ = 0;
};

}  // namespace depthgrid
