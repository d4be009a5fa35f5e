// Detects odometry that repeats one pose while the robot moves, as from a node that uses the latest
// transform after its source has stopped: the true poses are unknown.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"

namespace depthgrid {

class HeldPoses {
 public:
  // Adds the next scan of a log with its readings as logged: from `no_return_m` on no-returns,
  // below `min_range_m` no data.
  void Add(const Pose2& odom_from_laser, std::vector<double> range_m, double min_range_m,
           double no_return_m);

  // For each scan added, whether its pose equals that of the scan before bit for bit while half of
  // the readings changed. Somebody who fills the view of a standing robot has the same effect.
  // False until the log's poses have moved, as it may have no odometry.
  const std::vector<bool>& held() const { return held_; }
  int count() const { return static_cast<int>(std::count(held_.begin(), held_.end(), true)); }

 private:
  std::optional<Pose2> pose_;
  bool moves_ = false;           // a different pose occurred before
  std::vector<double> first_m_;  // the readings at the first scan with this pose
  std::vector<double> last_m_;
  std::size_t moved_from_ = 0;  // scans from this one to the last show motion
  std::vector<bool> held_;
};

}  // namespace depthgrid
