// The lines of a laser log, read one by one: a log can be larger than memory.
#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid {

// 20,000 readings and as many remissions fit; a longer "line" is a binary file.
constexpr std::size_t kMaxLineBytes = 1U << 20U;

// The text is valid until the next line is read. It has no line end and, for the first line, no
// byte order mark.
struct LogLine {
  std::string_view text;
  int number = 0;            // from 1
  bool is_too_long = false;  // above kMaxLineBytes; then the text is empty
  bool has_end = true;       // false if the file ends without a line end
};

// The constructor throws InputError for a file that is missing, compressed or no regular file, and
// every function for one that cannot be read: a part of a log is never taken for the whole.
class CarmenLines {
 public:
  explicit CarmenLines(std::string path);

  void Rewind();
  // Nothing at the end of the file.
  std::optional<LogLine> Next();
  // The number of the line read last; 0 before the first.
  int Number() const { return number_; }
  const std::string& Path() const { return path_; }

 private:
  std::string path_;
  std::ifstream file_;
  std::vector<char> buffer_;
  int number_ = 0;
};

}  // namespace depthgrid
