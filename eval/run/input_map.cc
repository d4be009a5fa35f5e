#include "eval/run/input_map.h"

#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"

namespace depthgrid {

OccupancyMap InputPoseMap(const MappingRun& run, const GridOptions& options) {
  MapDrawing drawing(options);
  std::size_t row = 0;
  for (const MappedFrame& mapped : run.result.mapped) {
    if (mapped.of_prior_map()) continue;
    while (run.reports[row].index != mapped.frame) ++row;
    drawing.Add(*mapped.obstacles, BaseOf(*run.reports[row].slam_from_camera));
  }
  return drawing.Map();
}

}  // namespace depthgrid
