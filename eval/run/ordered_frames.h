// Computes items for the frames of a sequence ahead of time on several threads and returns them in
// order. Each item is a pure function of its index, so the results do not depend on the number of
// threads.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace depthgrid {

template <typename Item>
class OrderedFrames {
 public:
  // `make(i)` for i in [0, count), called from `threads` threads: threads - 1 workers, and the
  // caller of Next(), which makes items itself instead of waiting. With one thread each item is
  // made on demand.
  OrderedFrames(int count, int threads, std::function<Item(int)> make)
      : count_(count), window_(kItemsAheadPerThread * threads), make_(std::move(make)) {
    try {
      for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { Work(); });
    } catch (const std::system_error&) {  // no more threads available: continue with fewer
    }
  }
  ~OrderedFrames() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    for (auto& worker : workers_) worker.join();
  }
  OrderedFrames(const OrderedFrames&) = delete;
  OrderedFrames& operator=(const OrderedFrames&) = delete;

  // The next item; empty at the end. Rethrows what `make` threw for it.
  std::optional<Item> Next() {
    std::unique_lock lock(mutex_);
    if (taken_ == count_) return std::nullopt;
    while (slots_.empty() || !slots_.front().done) {
      if (CanClaim()) {
        MakeOne(lock);
      } else {
        changed_.wait(lock);
      }
    }
    Slot slot = std::move(slots_.front());
    slots_.pop_front();
    ++taken_;
    changed_.notify_all();
    if (slot.error) std::rethrow_exception(slot.error);
    return std::move(slot.item);
  }

 private:
  // Enough that workers need not wait while the caller is busy with an item; bounds memory.
  static constexpr int kItemsAheadPerThread = 4;

  struct Slot {
    bool done = false;
    std::optional<Item> item;
    std::exception_ptr error;
  };

  bool CanClaim() const { return claimed_ < count_ && claimed_ - taken_ < window_; }

  // Called with the lock held; releases it while the item is made.
  void MakeOne(std::unique_lock<std::mutex>& lock) {
    const int index = claimed_++;
    slots_.emplace_back();
    lock.unlock();
    Slot made{.done = true, .item = std::nullopt, .error = nullptr};
    try {
      made.item = make_(index);
    } catch (...) {
      made.error = std::current_exception();
    }
    lock.lock();
    slots_[static_cast<std::size_t>(index - taken_)] = std::move(made);
    changed_.notify_all();
  }

  void Work() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopped_ || CanClaim() || claimed_ == count_; });
      if (stopped_ || claimed_ == count_) return;
      MakeOne(lock);
    }
  }

  const int count_;
  const int window_;
  const std::function<Item(int)> make_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Slot> slots_;  // items taken_ .. claimed_ - 1
  int claimed_ = 0;
  int taken_ = 0;
  bool stopped_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace depthgrid
