// What a laser sees in a room of 4 x 6 m, 2 m from the wall behind, as logs of odometry that holds
// its poses.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mapper/core/angle.h"
#include "mapper/core/pose2.h"
#include "mapper/core/rng.h"

namespace depthgrid {

// Half a circle of readings, to the millimetre.
inline std::vector<double> RoomReadings(const Pose2& pose, double sigma_m, RandomStream& random) {
  std::vector<double> range_m;
  for (int i = 0; i < 180; ++i) {
    const double angle_rad = pose.yaw_rad + RadFromDeg(i - 89.5);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double x_m = ((c > 0.0 ? 4.0 : -2.0) - pose.x_m) / c;
    const double y_m = ((s > 0.0 ? 2.0 : -2.0) - pose.y_m) / s;
    range_m.push_back(std::round((std::min(x_m, y_m) + sigma_m * random.Normal()) * 1e3) * 1e-3);
  }
  return range_m;
}

// The scan of a laser that is at `truth`, with the pose that the odometry gives for it.
inline std::string RoomLine(const Pose2& truth, const Pose2& told, double stamp_s,
                            RandomStream& random) {
  std::string line = "FLASER 180";
  for (const double range_m : RoomReadings(truth, 0.01, random)) {
    line += fmt::format(" {}", range_m);
  }
  const std::string pose = fmt::format("{} {} {}", told.x_m, told.y_m, told.yaw_rad);
  return line + fmt::format(" {0} {0} {1} host {1}\n", pose, stamp_s);
}

}  // namespace depthgrid
