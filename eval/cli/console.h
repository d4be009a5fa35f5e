// Messages for the user. Results go to standard output, everything else to standard error.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/mapping_run.h"
#include "mapper/core/counted.h"

namespace depthgrid::cli {

// Prints to standard error. Failures (such as a full disk) are ignored, because messages are not
// results.
void SayAside(const std::string& words);

// Shown after the last frame, while all poses are adjusted; for a long run that takes a minute or
// more.
inline const char* const kFinishingMap = "finishing the map";

// A progress bar with rate and remaining time; draws nothing unless standard error is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(int done, int total);
  // Shows a text in place of the bar, for work of unknown duration; on terminals only.
  void Say(const std::string& words);
  // Removes the bar, so that something else can be printed.
  void Clear();
  // `then`: text to show once all is done, for the work that follows; empty: none.
  Progress AsProgress(const std::string& then = "");

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool on_terminal_;
  struct Progressed {
    int done;
    Clock::time_point time;
  };
  bool drawn_ = false;  // anything
  bool shown_ = false;  // the bar itself
  std::optional<Progressed> first_;
  Clock::time_point last_drawn_;
};

// Prints the path of the report page.
void SayReport(const std::string& folder);
// Makes one printable line: control characters and bytes that are not UTF-8, as from a damaged
// file, become '?'.
std::string Printable(std::string text);

void Warn(const std::vector<std::string>& warnings);

// Opens standard streams that the caller closed. Otherwise the first file that the program opens
// would get a stream's number, and messages would be written into it.
void OpenStandardStreams();
// The error message when results cannot be printed.
std::string CannotPrint(const std::string& why);
// Flushes standard output. Throws std::runtime_error when output was lost (as on a full disk), so
// that half a table is not taken for a whole one.
void FinishOutput();

// Text of a table; the first column is left-aligned, the others are right-aligned.
std::string Table(const std::vector<std::vector<std::string>>& rows);

// Four significant digits.
std::string Short(double value);
// With `digits` decimals; "-" if empty; never "-0".
std::string Number(const std::optional<double>& value, int digits);

int ThreadsOr(int requested);

}  // namespace depthgrid::cli
