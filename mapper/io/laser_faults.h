// What a laser log's scans and odometry show to be wrong with them, and is mended while it is read.
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

  // The scans of the log, or of its part, in order; then Find().
  void Add(const CarmenScan& line);
  void Find();

  // By the order in which they were added.
  bool HasPose(std::size_t scan) const;  // else it was held
  bool HasScan(std::size_t scan) const;  // else it was frozen
  void DropBody(CarmenScan& line) const { body_.Drop(line); }
  // `first_frame` is that of the first scan added.
  std::vector<std::string> Warnings(const std::string& path, std::size_t first_frame) const;

 private:
  CarmenLogOptions options_;
  HeldPoses held_;
  FrozenScans frozen_;
  OwnBody body_;
  std::optional<Bearings> bearings_;  // of the first scan
};

}  // namespace depthgrid
