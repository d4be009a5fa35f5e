// SLAM's keys, as in an experiment: slam.profile, slam.loops.recall ...
#pragma once

#include "sim/slam/slam_options.h"

namespace depthgrid::cli {

struct SlamSettings {
  SlamOptions slam;
  void Visit(OptionsVisitor& v) { v.Group("slam", slam, "how SLAM errs"); }
};

}  // namespace depthgrid::cli
