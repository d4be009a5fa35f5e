// Whether a scan that repeats the one before exactly is no new one: a driver that hangs gives the
// last one again, which would match where that was taken, and distort the map.
#pragma once

#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"

namespace depthgrid {

// Whether a new scan would differ from this one after this motion of the laser, in its axes, of so
// many seconds: it turned by more than 2 degrees or moved by more than 5 cm, plus as much per
// second, more than odometry drifts while the robot stands. In addition the motion must change the
// ranges: in a bare corridor scans without noise may be equal.
bool MustDiffer(const Scan& scan, const Pose2& motion, double seconds);

}  // namespace depthgrid
