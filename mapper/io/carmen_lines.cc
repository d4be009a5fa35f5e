#include "mapper/io/carmen_lines.h"

#include <limits>
#include <utility>

#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {

CarmenLines::CarmenLines(std::string path) : path_(std::move(path)), buffer_(kMaxLineBytes) {
  RequireUncompressed(path_);
  Rewind();
}

void CarmenLines::Rewind() {
  RequireFile(path_);
  file_ = std::ifstream(path_, std::ios::binary);
  if (!file_) throw InputError(path_, "cannot be read");
  number_ = 0;
}

std::optional<LogLine> CarmenLines::Next() {
  file_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (file_.bad()) throw InputError(path_, "cannot be read");
  const bool has_end = !file_.eof();
  if (file_.fail() && !has_end) return std::nullopt;
  LogLine line{{}, ++number_, file_.fail(), has_end};
  if (line.is_too_long) {
    file_.clear();
    file_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    return line;
  }
  // getline counts the line end it took away.
  line.text = {buffer_.data(), static_cast<std::size_t>(file_.gcount()) - (has_end ? 1U : 0U)};
  if (number_ == 1) line.text = WithoutByteOrderMark(line.text);
  return line;
}

}  // namespace depthgrid
