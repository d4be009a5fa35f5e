// What the readings of a CARMEN log's scan line mean.
#pragma once

#include "mapper/core/scan.h"
#include "mapper/io/carmen_line.h"
#include "mapper/io/carmen_log.h"

namespace depthgrid {

struct LaserReach {
  double max_m = 0.0;
  double no_return_m = 0.0;  // readings from here on are no hit
};

// The setting, or where it says nothing what the SICK LMS reaches.
double MostRangeM(const CarmenLogOptions& options);
LaserReach ReachOf(const CarmenScan& line, const CarmenLogOptions& options);
// Of a line's readings, in the laser's axes.
Bearings BearingsOf(const CarmenScan& line, const CarmenLogOptions& options);

// odom_from_laser.
Pose2 LaserPoseOf(const CarmenScan& line, const CarmenLogOptions& options);
// ScanOf for a line and options that have been checked.
Scan ScanOfLine(const CarmenScan& line, const CarmenLogOptions& options);

}  // namespace depthgrid
