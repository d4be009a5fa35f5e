#include "mapper/core/usable_threads.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>
#include <vector>

namespace depthgrid {

int UsableThreads() {
  // The kernel refuses a mask of fewer cores than it may have.
  constexpr std::size_t kMostMasks = 64;  // of 1024 cores each
  for (std::size_t count = 1; count <= kMostMasks; count *= 2) {
    std::vector<cpu_set_t> masks(count);
    const std::size_t bytes = count * sizeof(cpu_set_t);
    if (::sched_getaffinity(::getpid(), bytes, masks.data()) == 0) {
      return std::max(CPU_COUNT_S(bytes, masks.data()), 1);
    }
    if (errno != EINVAL) break;
  }
  return std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
}

int UsableThreads(int requested) { return std::clamp(requested, 1, UsableThreads()); }

}  // namespace depthgrid
