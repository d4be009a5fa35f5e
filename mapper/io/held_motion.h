// When a sensor whose pose stays the same is taken to have moved.
#pragma once

#include <cstddef>

namespace depthgrid::internal {

// The sensor has moved if the median difference of its readings to those before exceeds this and
// this many times that of successive ones, which is noise. Chosen: a robot at 0.5 m/s and 10 Hz is
// detected after four scans.
constexpr double kMovedM = 0.05;
constexpr double kTimesNoise = 2.0;
// Poses are held from where this share of the change was reached.
constexpr double kBegunShare = 0.5;
// Fewer readings in common tell nothing.
constexpr std::size_t kFewReadings = 20;

}  // namespace depthgrid::internal
