// Every setting of the mapper; each group is documented beside its class.
#pragma once

#include "mapper/core/options.h"

namespace depthgrid {

enum class MapperMethod { kPaper, kSurfel };

struct MapperOptions {
  MapperMethod method = MapperMethod::kPaper;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
