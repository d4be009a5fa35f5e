#include "mapper/reference_factory.h"

#include "mapper/paper_reference.h"
#include "mapper/surfel/surfel_map.h"

namespace depthgrid {

std::unique_ptr<ReferenceMap> MakeReference(const MapperOptions& options) {
  if (options.method == MapperMethod::kSurfel) {
    return std::make_unique<SurfelMap>(options.surfel);
  }
  return std::make_unique<PaperReference>(options.grid, options.submap, options.match,
                                          options.graph);
}

}  // namespace depthgrid
