// Laser logs in CARMEN's text format: FLASER and ROBOTLASER1 lines become ready scans, and the
// laser's odometry pose in the line is the prior (docs/formats.md, "Laser logs"); of a log that has
// neither, RAWLASER1 lines with the poses of its ODOM lines. Other messages are ignored. Frames
// have the laser's poses even if the log states those of the base (CarmenLogOptions::mount).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/core/options.h"
#include "mapper/io/carmen_line.h"
#include "mapper/io/frame_names.h"
#include "mapper/io/frame_part.h"
#include "mapper/io/laser_mount.h"
#include "mapper/io/laser_sweep.h"

namespace depthgrid {

struct CarmenLogOptions {
  // A ROBOTLASER1 line states its own maximum, which is used if smaller. 0: the log's (PARAM
  // robot_front_laser_max), but at most 80 m, that of the SICK LMS of the old FLASER logs (which
  // write 81.83 for no return).
  double max_range_m = 0.0;
  // Angle from the first to the last reading of a FLASER line, centred ahead; 0: the SICK's half
  // circle.
  double fov_deg = 0.0;
  // For a laser mounted upside down, whose readings run from left to right.
  bool upside_down = false;
  // For logs that state the robot's pose in place of the laser's. Callers of ScanOf() must give
  // their frames the pose odom_from_base * mount.base_from_laser().
  LaserMount mount = {};
  // For scanners that turn slowly, whose readings differ in time. Not applied by ScanOf(), which
  // knows no motion: see AtStamp().
  LaserSweep sweep = {};
  // Nearer readings are "no data": scanners report 0 for "too near" or a fault.
  double min_range_m = 0.1;
  // Drops readings of the robot's own body, which stay the same while it turns (OwnBody).
  bool drop_body = true;
  // A no-return clears only this far, as it may also be glass, a mirror or black cloth; like
  // Cartographer's missing_data_ray_length (5 m).
  double no_return_clear_m = 5.0;
  // No-returns in a gap narrower than this between two hits are not an opening but glass, a shiny
  // edge or a fault, and clear only up to the nearer hit; otherwise such beams would show as free
  // streaks beyond every wall. A robot does not fit through 0.3 m.
  double no_return_gap_m = 0.3;

  void Visit(OptionsVisitor& v);
};

// The stamps of all scans as used, their numbers among the scan lines (damaged lines count, lines
// that repeat the previous stamp do not), and the range of the part.
FrameNames CarmenFrames(const std::string& path, const CarmenLogOptions& options = {},
                        const PartOptions& part = {});

// Converts the readings of a log line, or of any laser's driver, to a scan in the laser's axes (as
// in ROS's LaserScan, +infinity is no return, -infinity and NaN are no data). Throws InputError as
// RequireSound() does, and for options out of range.
Scan ScanOf(const CarmenScan& line, const CarmenLogOptions& options);

// Reads the file twice, line by line: here to count its scans, then through Next(); and once more
// if stamps decrease. Lines that are damaged, truncated or out of time order are left out and
// counted in Warnings(). If the clock was set back, later stamps are shifted to continue. Throws
// InputError for a file that cannot be read or has no scan.
//
// `loops`, ordered by the frame that reports them, join scans: the second pose in axes of the first
// (x forward, y left, z up), both poses of the body whose poses the log states (laser or base).
//
// For a part, frames and warnings are only of its scans, numbered as in the whole log; loops with
// an end outside it are left out.
struct CarmenLog {
  std::unique_ptr<FrameSource> source;
  FrameNames names;
};
CarmenLog OpenCarmenLog(const std::string& path, const CarmenLogOptions& options,
                        const std::vector<LoopClosure>& loops, const PartOptions& part);
std::unique_ptr<FrameSource> OpenCarmenLog(const std::string& path,
                                           const CarmenLogOptions& options = {},
                                           const std::vector<LoopClosure>& loops = {});

}  // namespace depthgrid
