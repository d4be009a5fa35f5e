// CPU time and wall time, for speed reports; no result depends on them.
#pragma once

#include <chrono>
#include <ctime>

namespace depthgrid {

// CPU time of the calling thread.
inline double ThreadCpuS() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double ThreadCpuUs() { return 1e6 * ThreadCpuS(); }

// Wall time from an arbitrary start.
inline double SteadyUs() {
  const auto since_start = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::micro>(since_start).count();
}

// CPU time of all threads of the program so far.
inline double ProcessCpuS() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace depthgrid
