// The default cache of a sweep or an ablation, which is in its folder while it runs.
#pragma once

#include <string>

namespace depthgrid {

// Removes the cache's files, including partial ones of a killed program, and folders that are then
// empty. Other files, and whatever is behind links, remain.
void RemoveSweepCache(const std::string& folder);

}  // namespace depthgrid
