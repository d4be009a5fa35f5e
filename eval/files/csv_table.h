// CSV files of numbers as this program writes them: a header line, commas, no quotes.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace depthgrid {

struct CsvTable {
  std::map<std::string, std::vector<double>> columns;  // NaN for an empty cell
  std::size_t rows = 0;

  // Throws InputError, which names the file, when there is no such column.
  const std::vector<double>& Column(const std::string& name) const;

  std::string place;
};

// Throws InputError for a missing file, a row of another length or a cell that is not a number.
CsvTable ReadCsv(const std::string& path);

}  // namespace depthgrid
