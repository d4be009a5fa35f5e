#include "eval/cli/interrupts.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

#include "mapper/io/end_task.h"

namespace depthgrid::cli {
namespace {

constexpr int kSignalled = 128;
// Written in a handler, which may run on two threads at once.
std::atomic<int> interrupted_by = 0;         // the first signal
std::atomic<long long> first_signal_ns = 0;  // its time
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<long long>::is_always_lock_free);

// One keystroke or one `timeout` may send a signal twice (to the program and to its group): within
// this time it is one request. After it a further one ends the program at once.
constexpr long long kSameRequestNs = 1'000'000'000;
// Time allowed for the next progress report; short enough not to annoy a user.
constexpr std::chrono::milliseconds kOrderlyEnd{500};
bool on_terminal = false;  // whether standard error is one; set before any signal
sem_t signalled;           // the one way in which a handler may wake a thread

// Never destroyed, because a thread may use it during exit.
struct Result {
  std::mutex mutex;
  std::string what;
};
Result& KnownResult() {
  static Result& result = *new Result;
  return result;
}

long long MonotonicNs() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void WriteError(std::string_view text) {
  [[maybe_unused]] const auto shown = write(STDERR_FILENO, text.data(), text.size());
}

// Uses only async-signal-safe functions.
void Remember(int signal) {
  const int saved_errno = errno;
  const long long now_ns = MonotonicNs();
  int none = 0;
  if (interrupted_by.compare_exchange_strong(none, signal)) {
    first_signal_ns = now_ns;
    if (on_terminal) WriteError("\ndepthgrid: stopping; again to end at once\n");
    sem_post(&signalled);
  } else if (first_signal_ns != 0 && now_ns - first_signal_ns > kSameRequestNs) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  errno = saved_errno;
}

// Ends the program with _exit(), whatever other threads are doing.
[[noreturn]] void EndWhenSignalled() {
  while (sem_wait(&signalled) != 0) {
  }
  std::this_thread::sleep_for(kOrderlyEnd);
  DoEndTasks();
  WriteError((on_terminal ? "\r\033[Kdepthgrid: " : "depthgrid: ") + InterruptText() + "\n");
  _exit(kSignalled + interrupted_by);
}

}  // namespace

void CatchInterrupts() {
  on_terminal = isatty(STDERR_FILENO) == 1;
  sem_init(&signalled, 0, 0);
  try {
    std::thread(EndWhenSignalled).detach();
  } catch (const std::system_error&) {  // no thread: only progress reports end the program
  }
  // With SIGXFSZ ignored, write() fails at `ulimit -f` as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Signals that the caller ignores (nohup, a shell's background jobs) remain ignored.
    if (std::signal(signal, &Remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

void ThrowIfInterrupted() {
  if (interrupted_by != 0) throw std::runtime_error("interrupted");
}

void NoteResult(const std::string& what) {
  const std::lock_guard lock(KnownResult().mutex);
  KnownResult().what = what;
}

std::string InterruptText() {
  const std::lock_guard lock(KnownResult().mutex);
  const std::string& what = KnownResult().what;
  return what.empty() ? "interrupted" : "interrupted; " + what;
}

std::optional<int> InterruptExitCode() {
  return interrupted_by == 0 ? std::nullopt : std::optional<int>(kSignalled + interrupted_by);
}

}  // namespace depthgrid::cli
