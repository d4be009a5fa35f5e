// What a sweep keeps beside its results while it runs, when nobody named another place for it.
#pragma once

#include <string>

namespace depthgrid {

// Removes the cache's files, also halves that a killed program left, and the folders that are empty
// then. What a user put there, or links to, stays.
void RemoveSweepCache(const std::string& folder);

}  // namespace depthgrid
