#include "mapper/io/trajectory_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr const char* kTumNames = "stamp x y z qx qy qz qw";
// Columns of files without a header that programs write with commas and w first: poses alone, with
// a velocity (both VINS) and with a velocity and two biases (EuRoC).
constexpr std::size_t kWFirstCounts[] = {8, 11, 17};
constexpr const char* kEuRocPosition = "p_rs_r";  // of the sensor S, the IMU, in the world R
constexpr std::size_t kRowsLookedAt = 10;         // the first few may be damaged
// Stamps in seconds are not whole numbers eleven days apart: these are nanoseconds, at most a
// thousand poses a second.
constexpr double kLeastStepNs = 1e6;

struct ColumnName {
  std::string word;  // in small letters
  std::string unit;
};

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"'";
  const std::size_t begin = std::min(text.find_first_not_of(kBlank), text.size());
  return text.substr(begin, text.find_last_not_of(kBlank) + 1 - begin);
}

ColumnName ColumnNameOf(std::string_view written) {
  const std::size_t end = std::min(written.find_first_of("[("), written.size());
  ColumnName name{std::string(Trimmed(written.substr(0, end))), ""};
  for (char& c : name.word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (end < written.size()) {
    const std::string_view unit = written.substr(end + 1);
    name.unit = unit.substr(0, unit.find_first_of(")]"));
  }
  // timestamp_ns
  const std::size_t last = name.word.rfind('_');
  if (name.unit.empty() && last != std::string::npos && name.word.starts_with("time")) {
    name.unit = name.word.substr(last + 1);
    name.word.resize(last);
  }
  return name;
}

std::vector<ColumnName> ColumnNamesIn(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of("#%/ \t"), line.size());
  line.remove_prefix(begin);
  std::vector<ColumnName> names;
  if (line.find(',') != std::string_view::npos) {
    for (const std::string_view name : SplitAtCommas(line)) names.push_back(ColumnNameOf(name));
    if (names.back().word.empty()) names.pop_back();  // a comma at the end of each line
    return names;
  }
  bool in_unit = false;  // a unit is a word of its own here, or several: [m s^-1]
  for (const TextRow& row : SplitRows(line)) {
    for (const std::string_view word : row.fields) {
      const bool begins = word.starts_with('[') || word.starts_with('(');
      if (begins && !names.empty()) names.back().unit = ColumnNameOf(word).unit;
      in_unit = in_unit || begins;
      if (!in_unit) names.push_back(ColumnNameOf(word));
      if (word.ends_with(']') || word.ends_with(')')) in_unit = false;
    }
  }
  return names;
}

template <std::size_t kCount>
bool IsOneOf(std::string_view word, const char* const (&words)[kCount]) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

// Where the column of a name goes: 0 the stamp, 1 to 3 x y z, 4 to 7 qx qy qz qw.
std::optional<std::size_t> RoleOf(std::string_view word) {
  constexpr const char* kStamps[] = {"stamp", "timestamp", "time", "t"};
  constexpr const char* kPositions[] = {"",    "t",        "p",          kEuRocPosition,
                                        "pos", "position", "translation"};
  constexpr const char* kRotations[] = {"q", "q_rs", "quat", "quaternion", "orientation"};
  if (IsOneOf(word, kStamps)) return 0;
  if (word.empty()) return {};
  const std::size_t axis = std::string_view("xyzw").find(word.back());
  if (axis == std::string_view::npos) return {};
  word.remove_suffix(1);
  if (word.ends_with('_') || word.ends_with('.')) word.remove_suffix(1);
  if (IsOneOf(word, kRotations)) return 4 + axis;
  if (axis < 3 && IsOneOf(word, kPositions)) return 1 + axis;
  return {};
}

double UnitsASecond(std::string_view unit) {
  if (unit == "s" || unit == "sec" || unit == "seconds") return 1.0;
  if (unit == "ms") return 1e3;
  if (unit == "us") return 1e6;
  if (unit == "ns" || unit == "nsec" || unit == "nanoseconds") return 1e9;
  return 0.0;
}

// Nothing unless the names have a stamp, a position and a quaternion, each once.
std::optional<TrajectoryColumns> ColumnsNamed(const std::vector<ColumnName>& names) {
  std::array<std::optional<std::size_t>, 8> at;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto role = RoleOf(names[i].word);
    if (!role) continue;
    if (at[*role]) return {};
    at[*role] = i;
  }
  if (!std::all_of(at.begin(), at.end(), [](const auto& column) { return column.has_value(); })) {
    return {};
  }
  TrajectoryColumns columns;
  columns.count = names.size();
  columns.stamp = *at[0];
  for (std::size_t i = 0; i < 3; ++i) columns.position[i] = *at[1 + i];
  for (std::size_t i = 0; i < 4; ++i) columns.rotation[i] = *at[4 + i];
  columns.of_imu = names[columns.position[0]].word.starts_with(kEuRocPosition);
  columns.units_a_second = UnitsASecond(names[columns.stamp].unit);
  return columns;
}

std::span<const TextRow> FirstRows(const std::vector<TextRow>& rows) {
  return std::span(rows).first(std::min(rows.size(), kRowsLookedAt));
}

// Whether the stamps are whole numbers that cannot be seconds.
bool HasNanoseconds(std::span<const TextRow> rows, std::size_t column) {
  std::vector<double> stamps;
  for (const TextRow& row : rows) {
    const auto stamp = column < row.fields.size() ? ParseNumber(row.fields[column]) : std::nullopt;
    if (stamp && std::isfinite(*stamp)) stamps.push_back(*stamp);
  }
  const auto is_whole = [](double stamp) { return stamp == std::floor(stamp); };
  if (stamps.empty() || !std::all_of(stamps.begin(), stamps.end(), is_whole)) return false;
  if (StampUnitsASecond(stamps.front()) == 1e9) return true;
  bool steps = false;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double step = std::abs(stamps[i] - stamps[i - 1]);
    if (step == 0.0) continue;
    if (step < kLeastStepNs) return false;
    steps = true;
  }
  return steps && StampUnitsASecond(stamps.front()) != 1e6;
}

// The number of columns that more than half of the rows have; 0 if there is none.
std::size_t UsualCountOf(std::span<const TextRow> rows) {
  for (const TextRow& row : rows) {
    const auto alike = std::count_if(rows.begin(), rows.end(), [&](const TextRow& other) {
      return other.fields.size() == row.fields.size();
    });
    if (2 * static_cast<std::size_t>(alike) > rows.size()) return row.fields.size();
  }
  return 0;
}

// The columns of rows that nothing names.
TrajectoryColumns UsualColumns(std::span<const TextRow> rows, const std::string& place) {
  TrajectoryColumns columns;
  const std::size_t count = UsualCountOf(rows);
  const bool has_commas = !rows.empty() && RestOf(rows.back(), 0).find(',') != std::string::npos;
  const bool is_known = std::find(std::begin(kWFirstCounts), std::end(kWFirstCounts), count) !=
                        std::end(kWFirstCounts);
  if (has_commas && is_known && HasNanoseconds(rows, columns.stamp)) {
    columns.count = count;
    columns.rotation = {5, 6, 7, 4};
    columns.units_a_second = 1e9;
    columns.of_imu = true;
    columns.taken =
        "no header names its columns; read as VINS and EuRoC write them, nanoseconds x y z qw qx "
        "qy qz (a first line #timestamp [ns],x,y,z,qx,qy,qz,qw, and so on, names others)";
  } else if (count > columns.count) {
    const auto first = std::find_if(rows.begin(), rows.end(),
                                    [&](const TextRow& row) { return row.fields.size() == count; });
    RequireText(*first, place);
    throw InputError(
        PlaceOfLine(place, first->line),
        fmt::format("has {}, must have 8, {}, or a header line before it that names all of them",
                    Counted(count, "column"), kTumNames));
  }
  return columns;
}

}  // namespace

std::optional<TrajectoryColumns> NamedColumns(std::string_view text) {
  text = WithoutByteOrderMark(text);
  std::optional<TrajectoryColumns> named;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view written = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(written.size() + 1, text.size()));
    const std::vector<TextRow> row = SplitRows(written);
    if (!row.empty() && ParseNumber(row.front().fields.front())) break;
    auto columns = ColumnsNamed(ColumnNamesIn(written));
    if (!columns) continue;
    columns->header_line = line;
    named = std::move(columns);
  }
  return named;
}

TrajectoryColumns ColumnsOf(std::string_view text, const std::vector<TextRow>& rows,
                            const std::string& place) {
  std::optional<TrajectoryColumns> columns = NamedColumns(text);
  if (!columns) return UsualColumns(FirstRows(rows), place);
  if (columns->units_a_second > 0.0) return *columns;
  std::span<const TextRow> looked_at = FirstRows(rows);
  if (!looked_at.empty() && looked_at.front().line == columns->header_line) {
    looked_at = looked_at.subspan(1);
  }
  const bool are_nanoseconds = HasNanoseconds(looked_at, columns->stamp);
  columns->units_a_second = are_nanoseconds ? 1e9 : 1.0;
  if (are_nanoseconds) {
    columns->taken = fmt::format(
        "line {} names no unit of the stamps; whole numbers of this size are read as nanoseconds",
        columns->header_line);
  }
  return *columns;
}

}  // namespace depthgrid
