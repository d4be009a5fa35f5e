// Parts of the robot in the view of its laser: a post, a wheel, a cable. They move with the robot,
// so they must neither be matched as static surfaces nor drawn along its path.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/io/carmen_line.h"

namespace depthgrid {

class OwnBody {
 public:
  // A run of neighbouring readings of the body.
  struct Part {
    std::size_t first = 0;
    std::size_t last = 0;
    double range_m = 0.0;  // median of the part's readings
  };

  // Adds the next scan of a log, with its odometry's heading. Lines with a different number of
  // readings than the first are ignored. Readings nearer than `min_range_m` are no data.
  void Add(const CarmenScan& line, double min_range_m);
  // Call after all scans. The body is readings nearer than 1 m that stay within 3 cm or 5 % of one
  // range in 95 % of the views. Between two views the robot turned by 20 degrees; 9 to 64 are used.
  // Nothing static or moving in a room looks like this.
  void Find();

  const std::vector<Part>& parts() const { return parts_; }
  // Sets readings of the body, and of its edges beside it, to "no data".
  void Drop(CarmenScan& line) const;

 private:
  double LastedAtM(std::size_t reading) const;  // 0: none

  std::size_t count_ = 0;  // of a line's readings
  double step_rad_ = 0.0;
  double yaw_rad_ = 0.0;                      // of the newest view
  std::vector<std::vector<double>> views_m_;  // 0 is no data
  std::vector<Part> parts_;
  std::vector<double> body_to_m_;  // per reading: nearer is the body; empty without a body
};

}  // namespace depthgrid
