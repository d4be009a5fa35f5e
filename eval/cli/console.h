// What the program says to a person at a terminal. Results go to standard output, everything else
// to standard error.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "eval/run/mapping_run.h"
#include "mapper/core/counted.h"

namespace depthgrid::cli {

// On standard error. Words that cannot be written there (a full disk) are lost: they are no result,
// and what is being done goes on.
void SayAside(const std::string& words);

// After the last frame all poses are adjusted: of a long run for a minute or more.
inline const char* const kFinishingMap = "finishing the map";

// A bar with rate and time left; draws nothing unless standard error is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Show(int done, int total);
  // Puts a few words in the bar's place, for work whose end is not known; terminals only.
  void Say(const std::string& words);
  // Takes the bar away, so that something else can be said.
  void Clear();
  // `then`: what is being done once all is shown to be done; empty: nothing.
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

// Where the page of what was done lies.
void SayReport(const std::string& folder);
// One line whatever it quotes of a damaged file: control characters and bytes that are no UTF-8
// become '?'.
std::string Printable(std::string text);

void Warn(const std::vector<std::string>& warnings);

// A standard stream that the caller closed would be the first file the program opens, and words for
// the screen would be written into it.
void OpenStandardStreams();
// The message of results that could not be printed.
std::string CannotPrint(const std::string& why);
// What was printed reached its file or pipe; throws std::runtime_error when it did not (a full
// disk), so that half a table is not taken for a whole one.
void FinishOutput();

// Columns as wide as their widest cell; the first is left-aligned, the others right-aligned.
std::string Table(const std::vector<std::vector<std::string>>& rows);

// Four significant digits, whatever the size.
std::string Short(double value);
// "-" for nothing; what is 0 in so many digits has no sign.
std::string Number(const std::optional<double>& value, int digits);

int ThreadsOr(int requested);

}  // namespace depthgrid::cli
