// Standard deviation of SLAM's motion, as estimated by the joint adjustment.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

// Standard deviation of SLAM's motion per frame, estimated from motions over `frames` frames on the
// assumption that it grows linearly with their number. Base axes (forward m, left m, yaw rad).
struct MotionSpread {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  double frames = 1.0;
  int stretches = 0;  // number of groups of frames with surfels
  // `sigma` over the root of the share of the motion that was observed; infinite where none was.
  Eigen::Vector3d seen_sigma = Eigen::Vector3d::Zero();

  // Fewer are not reliable: from seven in the first 60 frames, a prior that drifts by 0.375 m was
  // estimated as nearly perfect (docs/tried.md, "A nearly perfect prior").
  bool IsSure() const { return stretches >= 20; }
  // With fewer, an axis is used only if it is well observed and SLAM's error along it is small;
  // otherwise matches should dominate (docs/math.md, "The first frames again").
  bool Tells(int axis) const { return IsSure() || seen_sigma[axis] <= 0.01; }
};

}  // namespace depthgrid
