// Which column of a trajectory's rows is what: TUM's order, the one that a header line names
// (EuRoC, RTAB-Map, spreadsheets), or that of VINS, whose files have no header.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapper/io/number_rows.h"

namespace depthgrid {

struct TrajectoryColumns {
  std::size_t count = 8;
  std::size_t stamp = 0;
  std::array<std::size_t, 3> position = {1, 2, 3};     // x y z
  std::array<std::size_t, 4> rotation = {4, 5, 6, 7};  // qx qy qz qw
  double units_a_second = 1.0;
  int header_line = 0;  // from 1; 0: none
  bool of_imu = false;  // EuRoC's and VINS's poses are those of the IMU
  // What nothing in the file states and was taken for granted; empty if there is no such thing.
  std::string taken;
};

// The columns that one of the lines before the first row of numbers names, if they are a stamp, a
// position and a quaternion, whatever else. `units_a_second` is 0 if no unit is named.
std::optional<TrajectoryColumns> NamedColumns(std::string_view text);

// `rows`: those of `text`. Throws InputError if they have more columns than TUM's, which nothing
// names.
TrajectoryColumns ColumnsOf(std::string_view text, const std::vector<TextRow>& rows,
                            const std::string& place);

}  // namespace depthgrid
