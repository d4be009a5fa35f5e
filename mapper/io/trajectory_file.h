// Trajectories of one pose a line. TUM's, which are written too, are lines `stamp tx ty tz qx qy qz
// qw`, one space between columns, `#` comments; trajectory_columns.h has the others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/damage.h"

namespace depthgrid {

// The usable poses of a recorded trajectory, in strictly increasing order of stamps. Repairs are
// counted.
struct TrajectoryFile {
  Trajectory poses;
  std::string taken;                       // TrajectoryColumns::taken
  bool of_imu = false;                     // TrajectoryColumns::of_imu
  int unsorted_stamps = 0;                 // rows earlier than their predecessor, sorted
  std::optional<std::string> clock_doubt;  // DoubtOfSorted
  Tally doubled_stamps;                    // all but the first row of each stamp, dropped
  // Dropped rows: damaged ones, and as left out those with NaN, a zero quaternion or too far away.
  RowDamage damage;

  std::vector<std::string> Warnings(const std::string& name) const;
};

// A row is damaged if it does not have a number in each column, its stamp is not finite or the norm
// of its quaternion is not near 1. Throws InputError for an unreadable file and for one with mostly
// damaged rows.
TrajectoryFile ReadTrajectoryFile(const std::string& path);
// The same from text; `place` names it in errors.
TrajectoryFile ParseTrajectory(const std::string& text, const std::string& place);
// Only the poses; also throws InputError if there is none or any row is damaged.
Trajectory ReadTrajectory(const std::string& path);
// Tolerates damaged rows; repairs are added to `warnings`.
Trajectory ReadTrajectory(const std::string& path, std::vector<std::string>& warnings);
// The poses of a file that was read.
Trajectory PosesOf(TrajectoryFile file, const std::string& place,
                   std::vector<std::string>& warnings);

// Stamps with six decimals, pose values in the shortest form that parses to the same double.
std::string TrajectoryText(const Trajectory& trajectory);
void WriteTrajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace depthgrid
