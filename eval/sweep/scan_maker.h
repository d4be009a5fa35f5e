// Makes the scans of many sets at once: each depth image is rendered and disturbed once, whatever
// the number of SLAM trajectories it is read with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eval/sweep/scan_set.h"

namespace depthgrid {

struct ScanMakerContext {
  int threads = 1;
  std::string cache_folder;    // of rendered depth and of scans; empty for none
  std::function<void()> tick;  // called often from one thread at a time; may throw to stop
};

// Throws InputError when such a folder can be no cache, before any set fails by it.
void RequireUsableCache(const std::string& cache_folder);

// Fills `scans` of each set, or `failure`. Sets that have a failure already are left alone.
void MakeScans(const std::vector<ScanSet*>& sets, const ScanMakerContext& context);

}  // namespace depthgrid
