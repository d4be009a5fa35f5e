// Laser logs in CARMEN's text format: FLASER and ROBOTLASER1 lines become ready scans, and the
// laser's odometry pose in the line is the prior (docs/formats.md, "Laser logs"). Other messages of
// a log (ODOM, RAWLASER1, ...) are passed over. Frames have the laser's poses, also where a setting
// says that the log's are those of the base (CarmenLogOptions::mount).
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

namespace depthgrid {

struct CarmenLogOptions {
  // A ROBOTLASER1 line states its own maximum, which is used when smaller. 0 takes the log's own
  // (PARAM robot_front_laser_max), or 80 m where it has none or a larger one: that is the SICK LMS
  // that the old FLASER logs were recorded with (they write 81.83 for "no return").
  double max_range_m = 0.0;
  // What a FLASER line's readings span from the first to the last, half of it to either side; 0 is
  // the SICK's half circle.
  double fov_deg = 0.0;
  // A laser mounted upside down writes from left to right what others write from right to left.
  bool upside_down = false;
  // Of logs that write the robot's pose where the laser's belongs. Who makes frames of ScanOf()
  // gives them the pose odom_from_base * mount.base_from_laser().
  LaserMount mount = {};
  // Nearer readings are "no data": 0 is how scanners report "too near" or a fault.
  double min_range_m = 0.1;
  // Readings that stay the same while the robot turns are its own body and left out (OwnBody).
  bool drop_body = true;
  // A reading at the maximum says "nothing there", which also glass, mirrors and black cloth say;
  // so it clears this far only, as Cartographer's missing_data_ray_length (5 m) does.
  double no_return_clear_m = 5.0;
  // A gap of readings without return that is narrower than this between two hits is no opening but
  // glass, a shiny edge or a fault: it clears up to the nearer hit only, or the fringe of each such
  // beam shows beyond every wall. 0.3 m is less than what a robot drives through.
  double no_return_gap_m = 0.3;

  void Visit(OptionsVisitor& v);
};

// The scans' stamps as they are taken, and their numbers among the lines that are scans: damaged
// ones count, those with the stamp of the scan before do not. All of them, and which are the part.
FrameNames CarmenFrames(const std::string& path, const CarmenLogOptions& options = {},
                        const PartOptions& part = {});

// What a line's readings mean, or those of any laser's driver (ROS's LaserScan: +infinity is
// "nothing there", -infinity and NaN are no data): a scan in the laser's own axes. Throws
// InputError for bearings that are not finite or all the same, for a maximum that is negative or
// NaN, and for options out of range.
Scan ScanOf(const CarmenScan& line, const CarmenLogOptions& options);

// Reads the file twice, line by line: once here to count its scans, once through Next(); and once
// more where stamps fall. Lines that are damaged, truncated or out of time order are left out and
// counted in Warnings(). Where the clock was set back, stamps go on as if it had not been. Throws
// InputError for a file that cannot be read or holds no scan at all.
//
// `loops`, ordered by the frame that reports them, join scans: the second pose in the first one's
// axes (x forward, y left, z up), both of what the log's poses are of.
//
// Of a part its scans alone are given, numbered as in the whole log, and warned of; loops with an
// end outside it are left out.
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
