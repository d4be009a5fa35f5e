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

  // Add the poses of all scans of the log and those scans that are of the part in order, then call
  // Find().
  void AddPose(const CarmenScan& line, int epoch);
  void Add(const CarmenScan& line);
  void Find();

  // The pose of a scan of the log, whether its line or what it was interpolated from states it, and
  // whether it is not known, as it was held.
  Pose2 PoseOr(std::size_t scan, const Pose2& logged) const { return held_.PoseOr(scan, logged); }
  bool HasPose(std::size_t scan) const { return !held_.IsLost(scan); }
  // `scan` is the index in the order of adding.
  bool HasScan(std::size_t scan) const;  // false: the scan was frozen
  void DropBody(CarmenScan& line) const { body_.Drop(line); }
  std::vector<std::string> Warnings(const std::string& path, const FramePart& part) const;

 private:
  CarmenLogOptions options_;
  HeldPoses held_;
  FrozenScans frozen_;
  OwnBody body_;
  std::optional<Bearings> bearings_;  // of the first scan
};

}  // namespace depthgrid
