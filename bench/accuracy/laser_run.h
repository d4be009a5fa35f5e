// Shared by the programs that map simulated laser logs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mapper/core/level.h"
#include "mapper/io/carmen_line.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/trajectory_file.h"
#include "sim/laser/laser_world.h"

namespace depthgrid {

// The base poses of NAME.truth.txt, whose axes are those of the base.
inline std::vector<Pose2> ReadPlanarTruth(const std::string& name) {
  std::vector<Pose2> truth;
  for (const StampedPose& pose : ReadTrajectory(name + ".truth.txt")) {
    truth.push_back(PlanarPoseOf(pose.world_from_camera));
  }
  return truth;
}

// The laser's scan at this pose with the noise of this frame.
inline std::shared_ptr<const Scan> SimulatedScan(const LaserWorld& world,
                                                 const Pose2& world_from_base,
                                                 const LaserOptions& laser, int seed, int frame) {
  CarmenScan line;
  line.first_bearing_rad = laser.FirstBearingRad();
  line.bearing_step_rad = laser.BearingStepRad();
  line.max_range_m = laser.max_range_m;
  line.range_m = DisturbScan(CastScan(world, world_from_base, laser), laser,
                             static_cast<std::uint64_t>(seed), frame);
  return std::make_shared<const Scan>(ScanOf(line, {}));
}

}  // namespace depthgrid
