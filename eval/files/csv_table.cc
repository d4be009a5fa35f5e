#include "eval/files/csv_table.h"

#include <fmt/format.h>

#include <limits>
#include <string_view>

#include "mapper/core/counted.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

double CellValue(std::string_view cell, const std::string& place) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = ParseNumber(cell);
  if (!value) throw InputError(place, fmt::format("'{}' is not a number", cell));
  return *value;
}

}  // namespace

const std::vector<double>& CsvTable::Column(const std::string& name) const {
  const auto found = columns.find(name);
  if (found == columns.end()) throw InputError(place, "has no column '" + name + "'");
  return found->second;
}

CsvTable ReadCsv(const std::string& path) {
  const std::string text = ReadTextFile(path);
  CsvTable table;
  table.place = path;
  std::vector<std::string_view> names;
  std::vector<std::vector<double>> columns;
  std::string_view rest = text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    const auto cells = SplitAtCommas(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line == 1) {
      names = cells;
      columns.resize(names.size());
      continue;
    }
    const std::string place = PlaceOfLine(path, line);
    if (cells.size() != names.size()) {
      throw InputError(
          place, fmt::format("has {}, must have {}", Counted(cells.size(), "cell"), names.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) columns[i].push_back(CellValue(cells[i], place));
    ++table.rows;
  }
  if (names.empty()) throw InputError(path, "is empty");
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.columns[std::string(names[i])] = std::move(columns[i]);
  }
  return table;
}

}  // namespace depthgrid
