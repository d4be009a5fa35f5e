// The reference map a method stands for.
#pragma once

#include <memory>

#include "mapper/mapper_options.h"
#include "mapper/reference_map.h"

namespace depthgrid {

std::unique_ptr<ReferenceMap> MakeReference(const MapperOptions& options);

}  // namespace depthgrid
