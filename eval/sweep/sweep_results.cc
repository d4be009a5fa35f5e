#include "eval/sweep/sweep_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include "eval/sweep/sql_values_impl.h"
#include "eval/sweep/sweep_database.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"

namespace depthgrid {
namespace {

// RFC 4180: quoted only if it contains a comma, a quote or a line break.
std::string CsvCell(const std::string& text) {
  return text.find_first_of(",\"\n\r") == std::string::npos ? text : Quoted(text);
}

std::string CsvCell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

[[noreturn]] void FailFinding(const std::string& folder, const char* what, const std::string& name,
                              const std::vector<std::string>& names) {
  constexpr std::size_t kMostListed = 12;
  std::string hint = DidYouMeanColumn(name, names);
  if (hint.empty() && !names.empty() && names.size() <= kMostListed) {
    hint = fmt::format(", must be one of {}", fmt::join(names, ", "));
  }
  throw InputError(folder, fmt::format("has no {} '{}'{}", what, name, hint));
}

}  // namespace

std::string DidYouMeanColumn(const std::string& name, const std::vector<std::string>& names) {
  const auto goes_on = [&](const std::string& column) { return column.starts_with(name); };
  if (!name.empty() && std::ranges::count_if(names, goes_on) == 1) {
    return fmt::format(", did you mean '{}'?", *std::ranges::find_if(names, goes_on));
  }
  const std::string block = name.substr(0, name.find('.') + 1);
  const std::size_t last = name.rfind('.') + 1;
  std::vector<std::string> of_block;
  std::ranges::copy_if(names, std::back_inserter(of_block),
                       [&](const std::string& column) { return column.starts_with(block); });
  const auto last_of = [](const std::string& path) { return path.substr(path.rfind('.') + 1); };
  const auto begun = std::ranges::find_if(of_block, [&](const std::string& column) {
    return last < name.size() && last_of(column).starts_with(name.substr(last));
  });
  if (begun != of_block.end()) {
    // The dot makes it different from every column; the column itself would not be suggested.
    return DidYouMeanKey(name.substr(0, last) + "." + last_of(*begun), of_block, false);
  }
  const std::string near = DidYouMean(name, names);
  return near.empty() ? DidYouMeanKey(name, names, true) : near;
}

bool IsSeedKey(const std::string& key) {
  return key == "seed" || key == "depth_seed" || key == "slam_seed" || key == "trajectory_seed";
}

bool IsFileKey(const std::string& key) { return key == "scene" || key == "trajectory"; }

bool SweepParameter::IsSeed() const { return IsSeedKey(key); }

bool SweepParameter::IsNumeric() const {
  return std::none_of(numbers.begin(), numbers.end(), [](double v) { return std::isnan(v); });
}

bool SweepResults::HasParameter(const std::string& key) const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const SweepParameter& parameter) { return parameter.key == key; });
}

std::string SweepResults::EnvironmentText(const std::string& key) const {
  const auto found = environment.find(key);
  return found == environment.end() ? "" : found->second;
}

std::vector<std::uint64_t> SweepResults::ScoreBits(std::size_t row) const {
  std::vector<std::uint64_t> bits;
  for (const SweepColumn& column : metrics) {
    bits.push_back(std::bit_cast<std::uint64_t>(column.values[row]));
  }
  return bits;
}

const SweepParameter& SweepResults::Parameter(const std::string& key) const {
  std::vector<std::string> keys;
  for (const SweepParameter& parameter : parameters) {
    if (parameter.key == key) return parameter;
    keys.push_back(parameter.key);
  }
  FailFinding(folder, "axis", key, keys);
}

const std::vector<double>& SweepResults::Metric(const std::string& name) const {
  std::vector<std::string> names;
  for (const SweepColumn& metric : metrics) {
    if (metric.name == name) return metric.values;
    names.push_back(metric.name);
  }
  FailFinding(folder, "metric", name, names);
}

SweepResults ReadSweep(const std::string& folder) {
  return SweepDatabase::OpenToRead(folder).Results();
}

std::string ResultsCsv(const SweepResults& results) {
  std::vector<std::string> cells = {"run", "point"};
  for (const SweepParameter& parameter : results.parameters)
    cells.push_back(CsvCell(parameter.key));
  cells.emplace_back("failed");
  for (const SweepColumn& column : results.metrics) cells.push_back(CsvCell(column.name));
  for (const SweepColumn& column : results.times) cells.push_back(CsvCell(column.name));
  std::string csv = fmt::format("{}\n", fmt::join(cells, ","));
  for (std::size_t row = 0; row < results.rows(); ++row) {
    cells = {fmt::format("{}", results.runs[row]), fmt::format("{}", results.points[row])};
    for (const SweepParameter& parameter : results.parameters) {
      cells.push_back(CsvCell(parameter.texts[row]));
    }
    cells.emplace_back(results.failures[row].empty() ? "0" : "1");
    for (const SweepColumn& column : results.metrics) cells.push_back(CsvCell(column.values[row]));
    for (const SweepColumn& column : results.times) cells.push_back(CsvCell(column.values[row]));
    csv += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return csv;
}

}  // namespace depthgrid
