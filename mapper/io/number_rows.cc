#include "mapper/io/number_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/core/plus_sign.h"

namespace depthgrid {
namespace {

constexpr std::string_view kSeparators = " \t,\r\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::vector<std::string_view> Split(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kSeparators);
    if (begin == std::string_view::npos) return fields;
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

// Detects decimal commas, as in "0,5 1,25 3".
bool HasDecimalCommas(std::string_view line) {
  int commas = 0, words = 0;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return words > 1 && commas > 0;
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    if (word.find_first_not_of("+-0123456789,eE") != std::string_view::npos) return false;
    const std::size_t comma = word.find(',');
    if (comma != std::string_view::npos) {
      if (comma == 0 || comma + 1 == word.size() || word.find(',', comma + 1) != word.npos) {
        return false;
      }
      ++commas;
    }
    ++words;
    line.remove_prefix(end);
  }
}

}  // namespace

std::string_view WithoutByteOrderMark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

std::vector<TextRow> SplitRows(std::string_view text) {
  text = WithoutByteOrderMark(text);
  std::vector<TextRow> rows;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    TextRow row{line, Split(text.substr(0, end))};
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!row.fields.empty() && row.fields.front().front() != '#') rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::string_view> SplitAtCommas(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> ParseNumber(std::string_view field) {
  field = WithoutPlus(field);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (field.empty() || error != std::errc{} || end != field.data() + field.size()) return {};
  return value;
}

bool HasLeadingZero(std::string_view number) {
  if (number.starts_with('+') || number.starts_with('-')) number.remove_prefix(1);
  return number.size() > 1 && number[0] == '0' && number[1] >= '0' && number[1] <= '9';
}

double StampUnitsASecond(double number) {
  constexpr double kLeastMicroseconds = 1e15;
  constexpr double kLeastNanoseconds = 1e17;
  if (number >= kLeastNanoseconds) return 1e9;
  if (number >= kLeastMicroseconds) return 1e6;
  return number >= kLatestStampS ? 1e3 : 1.0;
}

void RequireSeconds(double stamp_s, const std::string& place) {
  if (!std::isfinite(stamp_s)) throw InputError(place, "the stamp must be finite");
  if (std::abs(stamp_s) <= kLatestStampS) return;
  const double units_a_second = StampUnitsASecond(std::abs(stamp_s));
  throw InputError(
      place,
      fmt::format("the stamp is {:.6g}, must be in seconds, not in milli- or nanoseconds: "
                  "divide all stamps of the file by 1e{:.0f}{}",
                  stamp_s, std::log10(units_a_second),
                  units_a_second == 1e3 ? ", or by 1e9 if they do not count from 1970" : ""));
}

bool IsSameStamp(double a_s, double b_s) {
  constexpr double kApartS = 2e-6;  // avoids formatting most pairs
  return std::abs(a_s - b_s) < kApartS && fmt::format("{:.6f}", a_s) == fmt::format("{:.6f}", b_s);
}

std::string PositionBeyondReach(const Eigen::Vector3d& position_m, const std::string& place) {
  return fmt::format("{}: the position is ({:g}, {:g}, {:g}), must be finite and within 10,000 km",
                     place, position_m.x(), position_m.y(), position_m.z());
}

std::string PlaceOfLine(const std::string& path, int line) {
  return fmt::format("{}:{}", path, line);
}

std::string_view RestOf(const TextRow& row, std::size_t field) {
  const char* begin = row.fields[field].data();
  return {begin,
          static_cast<std::size_t>(row.fields.back().data() + row.fields.back().size() - begin)};
}

void RequireText(const TextRow& row, const std::string& path) {
  if (RestOf(row, 0).find('\0') == std::string_view::npos) return;
  throw InputError(PlaceOfLine(path, row.line),
                   "holds bytes that are zero (UTF-16?), must be UTF-8 text");
}

void RequirePlainColumns(const std::vector<TextRow>& rows, const std::string& path) {
  constexpr std::size_t kLooksAt = 10;  // a few may be damaged, or words
  const std::size_t looked_at = std::min(kLooksAt, rows.size());
  const auto require_few = [&](bool (*is_so)(std::string_view), const char* what) {
    std::vector<int> lines;
    for (std::size_t i = 0; i < looked_at; ++i) {
      if (is_so(RestOf(rows[i], 0))) lines.push_back(rows[i].line);
    }
    if (2 * lines.size() > looked_at) throw InputError(PlaceOfLine(path, lines.front()), what);
  };
  require_few([](std::string_view line) { return line.find(';') != std::string_view::npos; },
              "has semicolons between its columns, must have spaces or commas");
  require_few(HasDecimalCommas, "has decimal commas, must have decimal points");
}

std::vector<double> NumbersIn(const TextRow& row, std::size_t count, const std::string& path) {
  RequireText(row, path);
  if (row.fields.size() != count) {
    throw InputError(
        PlaceOfLine(path, row.line),
        fmt::format("has {}, must have {}", Counted(row.fields.size(), "column"), count));
  }
  std::vector<double> numbers;
  for (const std::string_view field : row.fields) {
    const std::optional<double> number = ParseNumber(field);
    if (!number) {
      throw InputError(PlaceOfLine(path, row.line),
                       fmt::format("'{}' is not a number", field.substr(0, 40)));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace depthgrid
