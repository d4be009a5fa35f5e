// Scans that a laser's driver gave again and again while the robot went on: they would be matched
// to the very place they were taken at, and pull the map after them.
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
  // The next scan of a log at the pose of its laser, with its readings as the log has them; what
  // they mean is asked of those that came before alone.
  void Add(double stamp_s, const Pose2& odom_from_laser, const std::vector<double>& range_m,
           const std::function<Scan()>& scan);

  // For each scan added: whether it is one of those that are the same to the last digit, from the
  // second on, and would not be by what the poses say: the laser turned by more than 2 degrees or
  // went by more than 5 cm, and as much for each second, which odometry that wanders while its
  // robot stands does not do. Readings without noise must also be of something that came nearer:
  // who drives along a bare corridor may see the same.
  const std::vector<bool>& frozen() const { return frozen_; }
  int count() const { return static_cast<int>(std::count(frozen_.begin(), frozen_.end(), true)); }

 private:
  double stamp_s_ = 0.0;  // of the first scan like the last one, as the rest
  Pose2 odom_from_laser_;
  std::vector<double> range_m_;
  std::size_t first_ = 0;
  std::vector<bool> frozen_;
};

}  // namespace depthgrid
