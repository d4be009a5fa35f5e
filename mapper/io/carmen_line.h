// One scan line of a CARMEN log (FLASER or ROBOTLASER1), from text.
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
  bool states_angles = true;    // FLASER does not: they are those of a half circle
  double stated_fov_rad = 0.0;  // as written; of what states angles
  double max_range_m = 0.0;     // 0 when the line does not state it (FLASER)
  std::vector<double> range_m;  // as written: 0, the maximum, NaN included
  Pose2 odom_from_laser;
  Pose2 odom_from_robot;        // the line's second pose; most logs repeat the first
  double stated_yaw_rad = 0.0;  // of odom_from_laser, as written: not wrapped
};

// Of a line's readings, in the laser's axes.
struct Bearings {
  double first_rad = 0.0;
  double step_rad = 0.0;  // below 0 of a laser mounted upside down

  double At(std::size_t reading) const {
    return first_rad + static_cast<double>(reading) * step_rad;
  }
};

// Of a laser's driver: throws InputError for bearings that are not finite or all the same, and for
// a maximum that is negative or NaN.
void RequireSound(const CarmenScan& scan);
// Of CarmenLogOptions: throws SettingError for what sweeps no surroundings.
void RequireFieldOfView(double fov_deg);

// PARAM robot_front_laser_max: from here on readings of the front laser say "nothing there".
struct CarmenMaximum {
  double range_m = 0.0;
};

// A line that is no scan: another message, a comment, an empty line.
struct CarmenOther {};
// The reason of a line that is not of such a log at all.
inline const std::string kNamelessLine = "a line that begins with no message name";
// A damaged line, and what is wrong with it.
struct CarmenDamage {
  std::string reason;
  bool is_scan = true;     // it begins as a scan
  std::string fault = {};  // of this very line: field, value and what it must be
};

using CarmenLine = std::variant<CarmenScan, CarmenMaximum, CarmenOther, CarmenDamage>;

CarmenLine ParseCarmenLine(std::string_view line);

}  // namespace depthgrid
