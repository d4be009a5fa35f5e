// Tasks to be done before the program ends, even when it must end at once while several threads are
// working: removing half-written files and folders. The list of tasks is global to the process.
#pragma once

#include <functional>
#include <mutex>

namespace depthgrid {

// Runs `task` when it goes out of scope, or earlier when the program has to end at once; then
// perhaps twice and on another thread.
class EndTask {
 public:
  explicit EndTask(std::function<void()> task);  // throws nothing
  ~EndTask();
  EndTask(const EndTask&) = delete;
  EndTask& operator=(const EndTask&) = delete;

 private:
  friend void DoEndTasks();
  std::function<void()> task_;
};

// While one exists, ending the program waits: for steps that must not be interrupted.
class EndDelay {
 public:
  EndDelay();
  EndDelay(const EndDelay&) = delete;
  EndDelay& operator=(const EndDelay&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

// Runs all tasks, the newest first. Only for a caller that ends the process next: from now on every
// construction or destruction of a task or delay blocks forever.
void DoEndTasks();

}  // namespace depthgrid
