// Odometry that gives one pose again and again while the robot drives on, as a node does that asks
// for the latest transform when its source has stopped: nothing is known of where it was.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"

namespace depthgrid {

class HeldPoses {
 public:
  // The next scan of a log, its readings as the log has them: from `no_return_m` on they are no
  // return, and no data below `min_range_m`.
  void Add(const Pose2& odom_from_laser, std::vector<double> range_m, double min_range_m,
           double no_return_m);

  // For each scan added: whether its pose, to the last bit that of the scan before, was held while
  // half of what the scan shows moved. Somebody who fills the view of a robot that stands is such a
  // motion as well. None in a log whose poses have not moved yet, as there is no odometry.
  const std::vector<bool>& held() const { return held_; }
  int count() const { return static_cast<int>(std::count(held_.begin(), held_.end(), true)); }

 private:
  std::optional<Pose2> pose_;
  bool moves_ = false;           // there was another pose before
  std::vector<double> first_m_;  // the readings where this pose came first
  std::vector<double> last_m_;
  std::size_t moved_from_ = 0;  // scans from here to the last one show that they moved
  std::vector<bool> held_;
};

}  // namespace depthgrid
