// Old laser logs whose scans are RAWLASER1 lines, which state no pose: that is interpolated between
// the ODOM lines around them.
#pragma once

#include <cstddef>
#include <vector>

#include "mapper/io/carmen_line.h"

namespace depthgrid {

// A pose farther from the next in time is not interpolated: a robot drives a curve in it.
inline constexpr double kMostOdometryGapS = 0.5;

class CarmenRaw {
 public:
  // Before the first line is read (again).
  void Rewind();
  // Call after the whole log was read through Take(). Whether it has RAWLASER1 lines: from here on
  // they are used.
  bool Begin();
  bool IsUsed() const { return is_used_; }
  // Takes the log's lines in their order and returns them as lines of other logs: RAWLASER1 and
  // ODOM as CarmenOther or, if they are used, RAWLASER1 as a scan with a pose or as damage.
  CarmenLine Take(CarmenLine line);

 private:
  CarmenLine Placed(CarmenScan scan) const;

  std::vector<CarmenOdometry> odometry_;  // of the whole log, in its order
  std::size_t passed_ = 0;                // of these
  bool has_scans_ = false;
  bool is_used_ = false;
};

}  // namespace depthgrid
