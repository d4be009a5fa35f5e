#include "sim/depth/usable_threads.h"

#include <tbb/info.h>

#include <algorithm>

namespace depthgrid {

int UsableThreads() { return tbb::info::default_concurrency(); }

int UsableThreads(int requested) { return std::clamp(requested, 1, UsableThreads()); }

}  // namespace depthgrid
