// Does the unfinished runs of a sweep. What runs share is made once: the room and its truth,
// noise-free depth (on disk), and the scans of each group of runs that differ only in the mapper
// (in memory, and on disk for later sweeps).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eval/sweep/sweep_database.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

struct SweepContext {
  int threads = 1;
  std::string cache_folder;  // of rendered depth and of scans; empty for none
  // Called often, by one thread at a time; may throw to stop.
  std::function<void(int done, int total)> progress;
};

// Every outcome is written to the database as soon as it is known. The final table depends neither
// on the number of threads nor on which runs were already finished. Returns the warnings of the
// runs done here (RunDoubts). Throws DiskFullError when an outcome or the cache's folders cannot be
// written for lack of room.
std::vector<std::string> DoRuns(const SweepPlan& plan, SweepDatabase& database,
                                const SweepContext& context);

// Estimate of the runs' duration, from a few frames of some of them and the frames of each.
struct SweepEstimate {
  double cpu_s = 0.0;   // 0 when every run tried failed
  std::string failure;  // of the first run tried
  int scan_sets = 0;
};
SweepEstimate EstimateSweep(const SweepPlan& plan, const std::vector<int>& runs,
                            const SweepContext& context);

}  // namespace depthgrid
