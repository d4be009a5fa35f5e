// TUM trajectories: `stamp tx ty tz qx qy qz qw` a line, one space between columns, `#` comments.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "mapper/io/damage.h"

namespace depthgrid {

// A recorded trajectory as far as it is usable: sorted by strictly increasing stamp. What had to be
// mended is counted.
struct TrajectoryFile {
  Trajectory poses;
  int unsorted_stamps = 0;                 // rows earlier than their predecessor: sorted
  std::optional<std::string> clock_doubt;  // DoubtOfSorted
  Tally doubled_stamps;                    // all but the first row of one stamp: dropped
  // Rows that are no pose, and left out those of NaN, a zero quaternion or too far away: dropped.
  RowDamage damage;

  std::vector<std::string> Warnings(const std::string& name) const;
};

// A row without eight numbers, with a stamp that is not finite or a quaternion whose norm is not
// near 1 is damaged. Throws InputError for an unreadable file and one with mostly such rows.
TrajectoryFile ReadTrajectoryFile(const std::string& path);
// The same from text; `place` names it in errors.
TrajectoryFile ParseTrajectory(const std::string& text, const std::string& place);
// Its poses alone; additionally throws InputError when there is none or any row is damaged.
Trajectory ReadTrajectory(const std::string& path);
// Damaged rows are survived; what was mended is added to `warnings`.
Trajectory ReadTrajectory(const std::string& path, std::vector<std::string>& warnings);
// Those of a file that was read.
Trajectory PosesOf(TrajectoryFile file, const std::string& place,
                   std::vector<std::string>& warnings);

// Stamps with six decimals, pose values in the shortest form that reads back as the same double.
std::string TrajectoryText(const Trajectory& trajectory);
void WriteTrajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace depthgrid
