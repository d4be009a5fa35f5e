// Detects odometry that repeats one pose while the robot moves: it is slower than the laser, or a
// node uses the latest transform after its source has stopped.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/core/view_change.h"
#include "mapper/io/held_gaps.h"

namespace depthgrid {

// What the mender of held poses knows of a scan.
struct OdometryPose {
  double stamp_s = 0.0;
  Pose2 odom_from_laser;
  int epoch = 0;
};

class HeldPoses {
 public:
  // Adds the next scan of a log with its readings as logged: from `no_return_m` on no-returns,
  // below `min_range_m` no data.
  void Add(const OdometryPose& pose, std::vector<double> range_m, double min_range_m,
           double no_return_m);
  // Call once after all scans were added.
  void Mend();

  // For each scan added, whether its pose equals that of the scan before bit for bit while half of
  // the readings changed. False until the log's poses have moved, as it may have no
  // odometry, and where the robot stood for a second and what changed is nearer only (StillView):
  // people who come. Who comes within that second has the same effect as motion.
  const std::vector<bool>& held() const { return held_; }

  // Since Mend(): of the scans held() or read while the odometry had no new pose (FindRepeated).
  // The latter are interpolated; others only over a second at most, and if the next pose is far
  // enough for what the readings changed by.
  const std::vector<HeldGap>& gaps() const { return gaps_; }
  // How many scans have each pose, 1 where most have their own.
  std::size_t times() const { return times_; }
  // Of a scan in the order of adding; nothing is known to be held before Mend().
  bool IsLost(std::size_t scan) const;                        // held and not interpolated
  Pose2 PoseOr(std::size_t scan, const Pose2& logged) const;  // interpolated, or as logged

 private:
  bool TellsTheWay(const OdometryPose& pose, const std::vector<double>& range_m) const;
  std::vector<TimedPose> Frames(const std::vector<bool>& repeated) const;

  std::vector<OdometryPose> poses_;
  bool moves_ = false;           // a different pose occurred before
  std::vector<double> first_m_;  // the readings at the first scan with this pose
  std::vector<double> last_m_;
  StillView still_;
  std::size_t moved_from_ = 0;  // scans from this one to the last show motion
  std::vector<bool> held_;
  // Scans held from `first` on whose next pose, at `end`, does not tell what was driven.
  struct Untold {
    std::size_t first = 0, end = 0;
  };
  std::vector<Untold> untold_;
  std::vector<HeldGap> gaps_;
  std::size_t times_ = 1;
  std::vector<std::optional<Pose2>> mended_;  // empty if none is held
};

}  // namespace depthgrid
