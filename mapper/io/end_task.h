// What must be done before a program ends, also when it has to end at once, in the middle of work
// on several threads: half-written files and folders are taken away. A process ends once for all
// its threads, so the list of these tasks is the process's.
#pragma once

#include <functional>
#include <mutex>

namespace depthgrid {

// Does `task` when it goes out of scope, or earlier when the program has to end at once; then
// perhaps twice, and on another thread.
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

// While one exists the program does not end at once: for steps that happen whole or not at all.
class EndDelay {
 public:
  EndDelay();
  EndDelay(const EndDelay&) = delete;
  EndDelay& operator=(const EndDelay&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

// Does all tasks, the youngest first. Only for a caller who ends the process next: whoever comes to
// the begin or the end of a task or a delay from now on waits there for ever.
void DoEndTasks();

}  // namespace depthgrid
