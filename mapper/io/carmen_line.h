// One line of a CARMEN log (a scan: FLASER, ROBOTLASER1 or RAWLASER1; odometry: ODOM), from text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "mapper/core/pose2.h"

namespace depthgrid {

struct CarmenScan {
  double stamp_s = 0.0;
  double first_bearing_rad = 0.0;
  double bearing_step_rad = 0.0;
  bool states_angles = true;    // FLASER does not; a half circle is assumed
  double stated_fov_rad = 0.0;  // as written, if angles are stated
  double max_range_m = 0.0;     // 0 when the line does not state it (FLASER)
  std::vector<double> range_m;  // as written: 0, the maximum, NaN included
  Pose2 odom_from_laser;
  Pose2 odom_from_robot;        // the line's second pose; most logs repeat the first
  double stated_yaw_rad = 0.0;  // of odom_from_laser, as written: not wrapped
};

// Bearings of a line's readings, in the laser's axes.
struct Bearings {
  double first_rad = 0.0;
  double step_rad = 0.0;  // negative for a laser mounted upside down

  double At(std::size_t reading) const {
    return first_rad + static_cast<double>(reading) * step_rad;
  }
};

// For scans from a driver: throws InputError for bearings that are not finite, all the same or
// beyond two turns (degrees), for a maximum that is negative or NaN, and for readings of which none
// is below 100 m (millimetres), unless they are few, hardly differ (codes for no return) or all
// lie within kUsualReachM.
void RequireSound(const CarmenScan& scan);
// Throws SettingError for an invalid CarmenLogOptions::fov_deg.
void RequireFieldOfView(double fov_deg);

// PARAM robot_front_laser_max: readings of the front laser from this range on are no-returns.
struct CarmenMaximum {
  double range_m = 0.0;
};

// PARAM robot_frontlaser_offset, _side_offset or _angular_offset: where the front laser is on the
// robot, one number of it.
struct CarmenOffset {
  enum class Of { kX, kY, kYaw };
  Of of = Of::kX;
  double value = 0.0;  // metres ahead or to the left; radians to the left
};

// RAWLASER1: a scan without poses.
struct CarmenRawScan {
  CarmenScan scan;
};

// ODOM: the robot's pose by its odometry.
struct CarmenOdometry {
  double stamp_s = 0.0;
  Pose2 odom_from_robot;
};

// Another message, a comment, an empty line.
struct CarmenOther {};
// The reason for a line that cannot be from such a log.
inline const std::string kNamelessLine = "a line that begins with no message name";
// A damaged line, and what is wrong with it.
struct CarmenDamage {
  std::string reason;
  bool is_scan = true;     // it starts as a scan line does
  std::string fault = {};  // details: field, value and the rule it breaks
  bool is_raw = false;     // RAWLASER1 or ODOM, of which most logs make no use
};

using CarmenLine = std::variant<CarmenScan, CarmenRawScan, CarmenOdometry, CarmenMaximum,
                                CarmenOffset, CarmenOther, CarmenDamage>;

CarmenLine ParseCarmenLine(std::string_view line);

}  // namespace depthgrid
