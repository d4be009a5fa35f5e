// Parts of the robot that its laser sees: a post, a wheel, a cable. They go with it wherever it
// goes, would be matched as what stands still, and drawn along its way.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/io/carmen_line.h"

namespace depthgrid {

class OwnBody {
 public:
  // Readings next to each other, all of the body.
  struct Part {
    std::size_t first = 0;
    std::size_t last = 0;
    double range_m = 0.0;  // the median of all of them
  };

  // The next scan of a log, with the heading of its odometry. Lines with another count of readings
  // than the first are not looked at. Nearer readings than `min_range_m` are no data.
  void Add(const CarmenScan& line, double min_range_m);
  // After all of them: readings nearer than 1 m that stayed within 3 cm or 5 % of one range in 95 %
  // of the scans, each of which the robot had turned by 20 degrees since the one before; 9 of them
  // at least, 64 at most. Nothing that stands in a room, walks ahead or is driven along stays like
  // that.
  void Find();

  const std::vector<Part>& parts() const { return parts_; }
  // Makes "no data" of what is the body, and of what shows its edge beside it.
  void Drop(CarmenScan& line) const;

 private:
  double LastedAtM(std::size_t reading) const;  // 0: it did not

  std::size_t count_ = 0;  // of a line's readings
  double step_rad_ = 0.0;
  double yaw_rad_ = 0.0;                      // of the newest view
  std::vector<std::vector<double>> views_m_;  // 0 is no data
  std::vector<Part> parts_;
  std::vector<double> body_to_m_;  // by reading: nearer is the body; empty where there is none
};

}  // namespace depthgrid
