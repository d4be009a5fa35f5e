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
  // `takes_offsets`: unless a mount is given, the log's own PARAM lines say where the laser is.
  explicit CarmenRaw(bool takes_offsets) : takes_offsets_(takes_offsets) {}
  // Before the first line is read (again).
  void Rewind();
  // Call after the whole log was read through Take(). Whether it has RAWLASER1 lines: from here on
  // they are used.
  bool Begin();
  bool IsUsed() const { return is_used_; }
  // Takes the log's lines in their order and returns them as lines of other logs: RAWLASER1 and
  // ODOM as CarmenOther or, if they are used, RAWLASER1 as a scan with a pose or as damage.
  CarmenLine Take(CarmenLine line);
  // By the PARAM lines so far.
  const Pose2& robot_from_laser() const { return robot_from_laser_; }

 private:
  void TakeOffset(const CarmenOffset& offset);
  CarmenLine Placed(CarmenScan scan) const;

  std::vector<CarmenOdometry> odometry_;  // of the whole log, in its order
  std::size_t passed_ = 0;                // of these
  bool takes_offsets_;
  Pose2 robot_from_laser_;
  bool has_scans_ = false;
  bool is_used_ = false;
};

}  // namespace depthgrid
