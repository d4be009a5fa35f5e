// Detects scans that a laser's driver repeats while the robot moves: each would match where the
// first was taken, and distort the map.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"

namespace depthgrid {

class FrozenScans {
 public:
  // Adds the next scan of a log: the laser's pose and the readings as logged. `scan` is called only
  // if they equal those before.
  void Add(double stamp_s, const Pose2& odom_from_laser, const std::vector<double>& range_m,
           const std::function<Scan()>& scan);

  // For each scan added, whether it repeats its predecessor exactly although, by the poses, it
  // MustDiffer() (mapper/core/frozen_scan.h), or a later repetition must.
  const std::vector<bool>& frozen() const { return frozen_; }
  int count() const { return static_cast<int>(std::count(frozen_.begin(), frozen_.end(), true)); }

 private:
  double stamp_s_ = 0.0;  // these three: of the first scan equal to the last one
  Pose2 odom_from_laser_;
  std::vector<double> range_m_;
  std::size_t first_ = 0;
  std::vector<bool> frozen_;
};

}  // namespace depthgrid
