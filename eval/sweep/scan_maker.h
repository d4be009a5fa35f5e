// Makes the scans of many sets together: each depth image is rendered and given noise once, however
// many SLAM trajectories it is used with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eval/sweep/scan_set.h"

namespace depthgrid {

struct ScanMakerContext {
  int threads = 1;
  std::string cache_folder;    // of rendered depth and of scans; empty for none
  std::function<void()> tick;  // called often, by one thread at a time; may throw to stop
};

// Throws InputError when the folder cannot be used as a cache, before the first set is made.
void RequireUsableCache(const std::string& cache_folder);

// Fills `scans` or `failure` of each set, except of those that already have a failure. Throws
// DiskFullError when there is no room for the folders of the cache.
void MakeScans(const std::vector<ScanSet*>& sets, const ScanMakerContext& context);

}  // namespace depthgrid
