// Processor time and time that passes, for reports of speed; no result depends on them.
#pragma once

#include <chrono>
#include <ctime>

namespace depthgrid {

// Of the calling thread.
inline double ThreadCpuS() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double ThreadCpuUs() { return 1e6 * ThreadCpuS(); }

// That passes, whoever uses the processor; from some start.
inline double SteadyUs() {
  const auto since_start = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::micro>(since_start).count();
}

// Of the program so far, all threads.
inline double ProcessCpuS() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace depthgrid
