// Every setting of the mapper; each group is documented beside its class.
#pragma once

#include "mapper/core/options.h"
#include "mapper/fuse/fusion_options.h"
#include "mapper/grid/grid_options.h"

namespace depthgrid {

enum class MapperMethod { kPaper, kSurfel };

struct MapperOptions {
  MapperMethod method = MapperMethod::kPaper;
  GridOptions grid;
  FusionOptions fusion;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
