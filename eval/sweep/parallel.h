// Runs independent tasks on several threads. A task's result must depend only on its index.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace depthgrid {

// Calls task(i) for i in [0, count), in any order, from `threads` threads, one of which is the
// caller. After the first exception no more tasks are started, and it is rethrown here.
template <typename Task>
void ForEachIndex(std::size_t count, int threads, const Task& task) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> helpers;
  helpers.reserve(std::min(count, static_cast<std::size_t>(std::max(0, threads - 1))));
  try {
    for (int i = 1; i < threads && static_cast<std::size_t>(i) < count; ++i) {
      helpers.emplace_back(work);
    }
  } catch (const std::system_error&) {  // no more threads available: continue with fewer
  }
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace depthgrid
