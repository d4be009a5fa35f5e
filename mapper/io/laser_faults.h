// Faults of a laser log's scans and odometry that are detected from all of them and repaired while
// reading.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/io/carmen_line.h"
#include "mapper/io/carmen_log.h"
#include "mapper/io/frozen_scans.h"
#include "mapper/io/held_poses.h"
#include "mapper/io/own_body.h"

namespace depthgrid {

class LaserFaults {
 public:
  explicit LaserFaults(const CarmenLogOptions& options) : options_(options) {}

  // Add the scans of the log, or of its part, in order, then call Find().
  void Add(const CarmenScan& line);
  void Find();

  // `scan` is the index in the order of adding.
  bool HasPose(std::size_t scan) const;  // false: the pose was held
  bool HasScan(std::size_t scan) const;  // false: the scan was frozen
  void DropBody(CarmenScan& line) const { body_.Drop(line); }
  // `first_frame` is the frame of the first scan added.
  std::vector<std::string> Warnings(const std::string& path, std::size_t first_frame) const;

 private:
  CarmenLogOptions options_;
  HeldPoses held_;
  FrozenScans frozen_;
  OwnBody body_;
  std::optional<Bearings> bearings_;  // of the first scan
};

}  // namespace depthgrid
