// Undoes what the laser's own motion does to a scan while it is swept (docs/formats.md, "Laser
// logs").
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mapper/core/options.h"
#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"

namespace depthgrid {

// When the readings of a scan are taken.
struct LaserSweep {
  double duration_s = 0.0;   // from the first reading to the last; 0: all at once
  double stamp_share = 0.0;  // share of it that has passed at the scan's stamp

  void Visit(OptionsVisitor& v);
};

// The velocity of a laser, from its poses in order of time.
class LaserVelocity {
 public:
  // The mean since the pose before, in the laser's axes as in AtStamp(); zero where that says
  // nothing: at the first pose, after a pause, and where no robot moves that fast. `epoch`: poses
  // of different ones have no motion between them.
  Eigen::Vector3d To(double stamp_s, const Pose2& odom_from_laser, int epoch);
  // Call where the pose is not known.
  void Lose() { before_.reset(); }

 private:
  struct Seen {
    double stamp_s = 0.0;
    Pose2 odom_from_laser;
    int epoch = 0;
  };
  std::optional<Seen> before_;
};

// Whether a scan's beams are listed in the order in which they were taken.
enum class SweepOrder { kAsListed, kReversed };

// The beams as they would be from where the laser is at the stamp. Bearings of the result need not
// increase, and may go beyond a full turn where the laser turns against its sweep. `velocity` at
// the stamp, in the laser's axes: forward m/s, left m/s, turning rad/s.
Scan AtStamp(Scan scan, const LaserSweep& sweep, SweepOrder order, const Eigen::Vector3d& velocity);

}  // namespace depthgrid
