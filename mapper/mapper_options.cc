#include "mapper/mapper_options.h"

namespace depthgrid {

void MapperOptions::Visit(OptionsVisitor& v) {
  v.Choice("method", method, {{MapperMethod::kPaper, "paper"}, {MapperMethod::kSurfel, "surfel"}},
           "what scans are matched against: the paper's submaps or surfels of everything seen");
  v.Group("grid", grid, "probability grids and the finished map");
  v.Group("fusion", fusion, "how SLAM's pose and the matched one become one (Eq. 3)");
}

}  // namespace depthgrid
