// Input data of the benchmarks, made once per run.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/frame.h"
#include "sim/depth/depth_camera.h"

namespace depthgrid::bench {

// A hand-held camera in a cluttered room of 100,000 triangles, tilted by up to 12 degrees. Together
// the images exceed the second-level cache, as with a real camera.
struct DepthWalk {
  PinholeCamera camera;
  std::vector<Pose3> poses;
  std::vector<DepthFrame> clean;
  std::vector<DepthImage> noisy;  // Handa's model
};
// ICL-NUIM's field of view at this many pixels; views from all around, none near another.
const DepthWalk& DepthWalkOf(int width_px, int height_px);
// Successive views as in a recording: 2.5 cm and 1.5 degrees apart, to and fro. Only the noisy
// images are kept.
const DepthWalk& DepthStrollOf(int width_px, int height_px);
// Adds the floor of a depth image of this width copied, the fastest anything can read and write it,
// and returns its name.
std::string AddCopyFloor(int width_px);

// A laser or levelled camera walking a closed round in a furnished room of 6 x 5 m: 1 % noise.
struct LaserWalk {
  std::vector<std::shared_ptr<const Scan>> scans;
  std::vector<Pose2> truth;
};
const LaserWalk& LaserWalkOf(int beams);

// Odometry with a slow drift for a walk that is repeated endlessly.
class DriftingOdometry {
 public:
  Pose2 Next(const Pose2& motion) {
    constexpr double kBiasM = 1e-4, kBiasRad = 1e-4;  // per frame: 3 mm and 0.2 degrees per second
    pose_ = pose_ * motion * Pose2{kBiasM, -0.5 * kBiasM, kBiasRad};
    return pose_;
  }
  void Start(const Pose2& pose) { pose_ = pose; }

 private:
  Pose2 pose_;
};

}  // namespace depthgrid::bench
