// How far SLAM's motion is off, as an adjustment of poses and map tells afterwards.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

// How SLAM's motion errs as seen from poses and map adjusted together: over stretches of so many
// frames, as that of one frame if it grows with their number. Standard deviations, base axes
// (forward m, left m, yaw rad).
struct MotionSpread {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  double frames = 1.0;
  int stretches = 0;  // that saw something
  // How well such a motion, of one frame, is told by what was seen; infinite where nothing tells
  // it.
  Eigen::Vector3d seen_sigma = Eigen::Vector3d::Zero();

  // Fewer are not believed for long: from the seven of the first 60 frames a prior that drifts
  // 0.375 m was once called nearly perfect (docs/tried.md, "A nearly perfect prior").
  bool IsSure() const { return stretches >= 20; }
  // Of so few it says nothing of an axis along which they hardly saw, nor of one along which SLAM
  // errs by so much that matches had better lead (docs/math.md, "The first frames again").
  bool Tells(int axis) const { return IsSure() || seen_sigma[axis] <= 0.01; }
};

}  // namespace depthgrid
