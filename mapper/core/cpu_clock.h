// Processor time, for reports of speed; no result depends on it.
#pragma once

#include <ctime>

namespace depthgrid {

// Of the calling thread.
inline double ThreadCpuS() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double ThreadCpuUs() { return 1e6 * ThreadCpuS(); }

// Of the program so far, all threads.
inline double ProcessCpuS() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace depthgrid
