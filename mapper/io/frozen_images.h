// Detects depth images that a driver repeats while the camera moves: they would be drawn and
// matched at wrong places.
#pragma once

#include <memory>

#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

class FrozenImages {
 public:
  // Whether the image equals those before it in every pixel although the camera has turned or moved
  // forward since the first of them: by more than .4 degrees or 1 cm plus five times as much per
  // second, more than SLAM jitters and drifts while the camera stands. Sideways motion does not
  // count, as a wall seen without noise may look the same. Call for every image with a pose, in
  // order of time; `slam_epoch` changes where poses before and after are not comparable.
  bool IsFrozen(std::shared_ptr<const DepthImage> image, const Pose3& slam_from_camera,
                double stamp_s, int slam_epoch);

 private:
  std::shared_ptr<const DepthImage> image_;  // the newest image that differed from its predecessor
  Pose3 slam_from_camera_;
  double stamp_s_ = 0.0;
  int slam_epoch_ = 0;
};

}  // namespace depthgrid
