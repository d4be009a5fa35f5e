// The cost of Eq. 4 at poses around a given one, to show where else a scan would fit.
#pragma once

#include <vector>

#include "mapper/core/pose2.h"
#include "mapper/match/match_points.h"
#include "mapper/match/probability_view.h"

namespace depthgrid {

// Offsets are along the map's axes; rotations are about the base's origin.
struct MatchSurface {
  double step_m = 0.0;
  int half_steps = 0;  // offsets -half_steps..half_steps in x and y
  // Root mean square of 1 - M over the points, row by row from the smallest y, at the given pose's
  // yaw.
  std::vector<double> residual;
  double yaw_step_rad = 0.0;
  std::vector<double> yaw_residual;  // at the given pose's position, whose yaw is in the middle
};

struct MatchSurfaceOptions {
  double half_window_m = 0.2;  // twice that of the correlative search
  double step_m = 0.01;
  double half_window_rad = 0.1;
  double yaw_step_rad = 0.005;
  int most_points = 160;  // of the scan, evenly spread; enough for a picture
};

MatchSurface MatchSurfaceAround(const MatchPoints& points, const ProbabilityView& view,
                                const Pose2& map_from_base, const MatchSurfaceOptions& options);

}  // namespace depthgrid
