// Does the runs of a sweep that are not done yet. What runs share is made once: the room and its
// truth, clean depth (on disk), and for each group of runs that differ in the mapper alone the
// scans (in memory, and on disk for the next time).
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
  // Told often, from one thread at a time; may throw to stop.
  std::function<void(int done, int total)> progress;
};

// Every outcome goes into the database as soon as it is known. The table at the end depends
// neither on threads nor on what was in the database before. Returns what the runs that were done
// showed to be likely not meant (RunDoubts).
std::vector<std::string> DoRuns(const SweepPlan& plan, SweepDatabase& database,
                                const SweepContext& context);

// How long the runs will take, from a few frames of the first of them; about.
struct SweepEstimate {
  double cpu_s = 0.0;   // 0 when each run that was tried failed
  std::string failure;  // of the first of those
  int scan_sets = 0;
};
SweepEstimate EstimateSweep(const SweepPlan& plan, const std::vector<int>& runs,
                            const SweepContext& context);

}  // namespace depthgrid
