// The reference map of the chosen method.
#pragma once

#include <memory>

#include "mapper/core/reference_map.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

std::unique_ptr<ReferenceMap> MakeReference(const MapperOptions& options);

}  // namespace depthgrid
