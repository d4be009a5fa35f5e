// The mounting pose of a laser on its robot.
#pragma once

#include "mapper/core/options.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// The laser's pose in base axes, where base is the body whose poses a log states. All zero: the log
// states the laser's poses.
struct LaserMount {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;

  Pose2 base_from_laser() const;
  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
