#include "eval/cli/console.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "eval/cli/interrupts.h"
#include "mapper/core/usable_threads.h"

namespace depthgrid::cli {
namespace {

std::string TimeText(double seconds) {
  const auto whole = static_cast<int>(seconds + 0.5);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

void SayAside(const std::string& words) {
  std::fputs(words.c_str(), stderr);
  std::fflush(stderr);
}

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { Clear(); }

void ProgressBar::Clear() {
  if (drawn_) SayAside("\r\033[K");
  drawn_ = false;
}

void ProgressBar::Say(const std::string& words) {
  if (!on_terminal_) return;
  SayAside(fmt::format("\r\033[K{} ...", words));
  drawn_ = true;
}

void ProgressBar::Show(int done, int total) {
  ThrowIfInterrupted();
  if (!on_terminal_ || total <= 0) return;
  constexpr std::chrono::milliseconds kRedraw{100};
  const auto now = Clock::now();
  if (!first_) first_ = {done, now};  // earlier progress does not count for the rate
  if (shown_ && now - last_drawn_ < kRedraw && done < total) return;
  constexpr int kBarWidth = 30;
  const int filled = static_cast<int>(static_cast<long long>(kBarWidth) * done / total);
  const double elapsed_s = std::chrono::duration<double>(now - first_->time).count();
  const double rate_hz = elapsed_s > 0.0 ? (done - first_->done) / elapsed_s : 0.0;
  const std::string left = rate_hz > 0.0 ? TimeText((total - done) / rate_hz) + " left" : "";
  const std::string rate = rate_hz > 0.0 ? fmt::format("{:.1f}/s  {}", rate_hz, left) : "";
  SayAside(fmt::format("\r\033[K{} [{:#<{}}{:.<{}}] {}/{}  {}", label_, "", filled, "",
                       kBarWidth - filled, done, total, rate));
  drawn_ = shown_ = true;
  last_drawn_ = now;
}

Progress ProgressBar::AsProgress(const std::string& then) {
  return [this, then](int done, int total) {
    Show(done, total);
    if (done == total && !then.empty()) Say(then);
  };
}

void SayReport(const std::string& folder) {
  const bool ends = folder.ends_with('/');
  fmt::print("look at {}{}report.html\n", folder, ends ? "" : "/");
}

std::string Printable(std::string text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    // Length of the sequence, from its first byte; the following bytes are 10xxxxxx.
    const unsigned char first = byte(i);
    const std::size_t length = first < 0x80                     ? 1
                               : first >= 0xc2 && first < 0xe0  ? 2
                               : first >= 0xe0 && first < 0xf0  ? 3
                               : first >= 0xf0 && first <= 0xf4 ? 4
                                                                : 0;
    bool sound = length > 0 && i + length <= text.size() && first >= 0x20 && first != 0x7f;
    for (std::size_t k = 1; sound && k < length; ++k) sound = (byte(i + k) & 0xc0) == 0x80;
    if (!sound) text[i] = '?';
    i += sound ? length : 1;
  }
  return text;
}

void Warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    SayAside(fmt::format("depthgrid: warning: {}\n", Printable(warning)));
  }
}

void OpenStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() returns the lowest free descriptor, which is this one.
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", O_RDWR);
  }
}

std::string CannotPrint(const std::string& why) {
  return "standard output: cannot be written: " + why;
}

void FinishOutput() {
  const bool flushed = std::fflush(stdout) == 0;
  const int error = errno;
  if (!flushed || std::ferror(stdout) != 0) {
    throw std::runtime_error(CannotPrint(std::strerror(flushed ? EIO : error)));
  }
}

std::string Table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i == 0) {
        line += fmt::format("{:<{}}", row[i], widths[i]);
      } else {
        line += fmt::format("  {:>{}}", row[i], widths[i]);
      }
    }
    text += line + "\n";
  }
  return text;
}

std::string Short(double value) { return fmt::format("{:.4g}", value + 0.0); }  // -0 as 0

std::string Number(const std::optional<double>& value, int digits) {
  if (!value) return "-";
  std::string text = fmt::format("{:.{}f}", *value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (is_zero && text.front() == '-') text.erase(0, 1);
  return text;
}

int ThreadsOr(int requested) { return requested > 0 ? requested : UsableThreads(); }

}  // namespace depthgrid::cli
