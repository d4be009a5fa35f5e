// True paths for tests of the SLAM surrogate.
#pragma once

#include <cmath>

#include "mapper/core/level.h"
#include "mapper/core/trajectory.h"

namespace depthgrid {

// A static camera, so that all motion is error.
inline Trajectory Standing(int frames, double step_s = 1.0 / 30.0) {
  Trajectory truth;
  for (int i = 0; i < frames; ++i) {
    truth.push_back({i * step_s, CameraOf({1.0, 2.0, 0.3}, 1.2)});
  }
  return truth;
}

// `laps` times round a circle of 2 m radius, looking outwards, 20 s a lap.
inline Trajectory Circling(double laps, double seconds_per_lap = 20.0) {
  Trajectory truth;
  const int frames = static_cast<int>(laps * seconds_per_lap * 30.0) + 1;
  for (int i = 0; i < frames; ++i) {
    const double angle_rad = 2.0 * kPi * i / (seconds_per_lap * 30.0);
    truth.push_back({i / 30.0, CameraOf({2.0 * std::cos(angle_rad), 2.0 * std::sin(angle_rad),
                                         WrapAngle(angle_rad)},
                                        1.2)});
  }
  return truth;
}

}  // namespace depthgrid
