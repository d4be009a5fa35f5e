#include "mapper/mapper_options.h"

namespace depthgrid {

void MapperOptions::Visit(OptionsVisitor& v) {
  v.Choice("method", method, {{MapperMethod::kPaper, "paper"}, {MapperMethod::kSurfel, "surfel"}},
           "what scans are matched against: the paper's submaps or surfels of everything seen");
  v.Group("scan", scan, "depth images to scans (Eq. 2)");
  v.Group("grid", grid, "probability grids and the finished map");
  v.Group("submap", submap, "paper: grids that scans are matched against");
  v.Group("match", match, "paper: scan to submap (Eq. 4)");
  v.Group("fusion", fusion, "how SLAM's pose and the matched one become one (Eq. 3)");
  v.Group("loops", loops, "which loops are believed");
  v.Group("graph", graph, "paper: how loops are closed (Eq. 5-6)");
  v.Group("surfel", surfel, "surfel: the map of surfels and its joint adjustment");
  v.Group("rounds", rounds, "surfel: when poses and map are adjusted during the run");
  v.Group("keep", keep, "whose scans are kept for the final map");
}

}  // namespace depthgrid
