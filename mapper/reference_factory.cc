#include "mapper/reference_factory.h"

#include "mapper/core/error.h"
#include "mapper/paper_reference.h"

namespace depthgrid {

std::unique_ptr<ReferenceMap> MakeReference(const MapperOptions& options) {
  if (options.method == MapperMethod::kSurfel) {
    throw InputError("mapper.method", "surfel is not available yet");
  }
  return std::make_unique<PaperReference>(options.grid, options.submap, options.match,
                                          options.graph);
}

}  // namespace depthgrid
