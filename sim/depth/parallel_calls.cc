#include "sim/depth/parallel_calls.h"

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include "mapper/core/usable_threads.h"

namespace depthgrid {

void CallInParallel(std::size_t count, int threads,
                    const std::function<void(std::size_t k)>& call) {
  if (threads == 1) {
    for (std::size_t k = 0; k < count; ++k) call(k);
    return;
  }
#ifdef __SANITIZE_THREAD__
  // oneTBB is not instrumented, so the thread sanitizer would report false races between its tasks.
  // With plain threads it reports only real races between calls.
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> helpers;
  for (int i = 0; i < threads; ++i) {
    helpers.emplace_back([&] {
      for (std::size_t k = next++; k < count; k = next++) call(k);
    });
  }
#else
  tbb::task_arena(UsableThreads(threads)).execute([&] {
    tbb::parallel_for(std::size_t{0}, count, call);
  });
#endif
}

}  // namespace depthgrid
