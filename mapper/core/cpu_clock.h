// Processor time of the calling thread, for reports of speed; no result depends on it.
#pragma once

#include <ctime>

namespace depthgrid {

inline double ThreadCpuS() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double ThreadCpuUs() { return 1e6 * ThreadCpuS(); }

}  // namespace depthgrid
