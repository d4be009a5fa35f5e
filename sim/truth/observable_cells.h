// The cells of the truth map whose state the camera could have observed (docs/truth.md).
#pragma once

#include <limits>

#include "mapper/core/camera.h"
#include "mapper/core/cell_set.h"
#include "sim/truth/truth_grid.h"

namespace depthgrid {

struct ObservableOptions {
  double min_range_m = 0.4;  // horizontal, as for the mapper's scans
  double max_range_m = 6.0;
  // z-depths that the sensor measures (sim/depth/sensor_options.h).
  double min_depth_m = 0.0;
  double max_depth_m = std::numeric_limits<double>::infinity();
  int threads = 1;
};

// At every pose level rays are cast from the camera's vertical axis, at most half a cell apart at
// their ends. They stop at the first surface of the band, whatever its height. Observable are the
// occupied cell where a ray ends, if some height of its surface in the band is in view, and the
// free cells before it in which the band's lower limit is in view (what is below the view cannot be
// known to be free). For a camera at a height inside the band the line of sight to such a cell is
// indeed clear. The result does not depend on any mapper.
CellSet ObservableCells(const TriangleMesh& mesh, double floor_z_m, const StateMap& truth,
                        const PinholeCamera& camera, const Trajectory& world_from_camera,
                        const TruthGridOptions& grid, const ObservableOptions& options);

}  // namespace depthgrid
