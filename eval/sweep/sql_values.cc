#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "eval/sweep/sql_values_impl.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {

std::string Quoted(const std::string& text) {
  std::string quoted(1, '"');
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}

void BindYaml(SQLite::Statement& statement, int index, const std::string& text) {
  constexpr double kExactIntegers = 9007199254740992.0;  // 2^53
  const auto number = ParseNumber(text);
  if (!number || !std::isfinite(*number) || fmt::format("{}", *number) != text) {
    statement.bind(index, text);
  } else if (std::trunc(*number) == *number && std::abs(*number) < kExactIntegers) {
    statement.bind(index, static_cast<std::int64_t>(*number));
  } else {
    statement.bind(index, *number);
  }
}

std::string YamlOf(const SQLite::Column& column) {
  if (column.isInteger()) return fmt::format("{}", column.getInt64());
  if (column.isFloat()) return fmt::format("{}", column.getDouble());
  return column.getString();
}

double NumberOf(const SQLite::Column& column) {
  return column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
}

std::vector<std::string> ColumnsOf(SQLite::Database& database, const std::string& table) {
  std::vector<std::string> names;
  SQLite::Statement query(database, "SELECT name FROM pragma_table_info('" + table + "')");
  while (query.executeStep()) {
    const std::string name = query.getColumn(0).getString();
    if (name != "run") names.push_back(name);
  }
  return names;
}

}  // namespace depthgrid
