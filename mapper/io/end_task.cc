#include "mapper/io/end_task.h"

#include <chrono>
#include <thread>
#include <vector>

namespace depthgrid {
namespace {

struct TaskList {
  std::recursive_mutex mutex;  // a task may write a file, which is a task
  std::vector<EndTask*> tasks;
};

// Never destroyed, as threads may run until the process ends.
TaskList& Tasks() {
  static TaskList& list = *new TaskList;
  return list;
}

}  // namespace

EndTask::EndTask(std::function<void()> task) : task_(std::move(task)) {
  const std::lock_guard lock(Tasks().mutex);
  Tasks().tasks.push_back(this);
}

EndTask::~EndTask() {
  const std::lock_guard lock(Tasks().mutex);
  task_();
  std::erase(Tasks().tasks, this);
}

EndDelay::EndDelay() : lock_(Tasks().mutex) {}

void DoEndTasks() {
  Tasks().mutex.lock();  // and never unlocks
  // A thread between registering a task and creating its file may still create it, so run the tasks
  // twice.
  constexpr std::chrono::milliseconds kOnItsWay{5};
  for (const bool again : {false, true}) {
    if (again) std::this_thread::sleep_for(kOnItsWay);
    const std::vector<EndTask*> tasks = Tasks().tasks;
    for (auto task = tasks.rbegin(); task != tasks.rend(); ++task) (*task)->task_();
  }
}

}  // namespace depthgrid
