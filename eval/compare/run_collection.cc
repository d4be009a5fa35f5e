#include "eval/compare/run_collection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>

#include "eval/files/metric_columns.h"
#include "eval/files/one_result.h"
#include "eval/sweep/sweep_database.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// A run's own file of scores or, for another mapper's, the output of `eval trajectory --json` and
// `eval map --json`.
std::vector<std::string> ScoreFiles(const fs::path& run) {
  const std::string all = (run / "metrics.json").string();
  if (fs::exists(all)) return {all};
  std::vector<std::string> files;
  for (const char* name : {"trajectory.json", "map.json"}) {
    if (fs::exists(run / name)) files.push_back((run / name).string());
  }
  return files;
}

bool IsRun(const fs::path& folder) {
  return fs::exists(folder / "run.yaml") && !ScoreFiles(folder).empty();
}

std::vector<fs::path> RunFolders(const std::string& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder, "no such folder");
  if (IsRun(folder)) return {folder};
  std::vector<fs::path> runs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && IsRun(entry.path())) runs.push_back(entry.path());
  }
  std::sort(runs.begin(), runs.end());
  if (runs.empty()) {
    throw InputError(folder,
                     "holds no sweep and no run with scores (run.yaml and metrics.json, or "
                     "trajectory.json, map.json)");
  }
  return runs;
}

void AddParameters(const fs::path& run, SweepResults& table) {
  constexpr std::array<const char*, 8> kKeys = {"scene",     "trajectory",     "movers",
                                                "frames",    "seed",           "depth_seed",
                                                "slam_seed", "trajectory_seed"};
  const Config settings = Config::FromFile((run / "run.yaml").string());
  if (table.parameters.empty()) {
    for (const char* key : kKeys) table.parameters.push_back({key, {}, {}});
  }
  for (SweepParameter& parameter : table.parameters) {
    const std::string text = settings.Text(parameter.key);
    parameter.texts.push_back(text);
    parameter.numbers.push_back(ParseNumber(text).value_or(kNothing));
  }
}

// Removes parameters that no run states.
void DropUnstated(SweepResults& table) {
  std::erase_if(table.parameters, [](const SweepParameter& parameter) {
    return std::all_of(parameter.texts.begin(), parameter.texts.end(),
                       [](const std::string& text) { return text.empty(); });
  });
}

// Adds the scores of the last row; new columns are empty for earlier rows.
void AddMetrics(const std::string& file, SweepResults& table) {
  const std::size_t row = table.rows() - 1;
  for (const auto& [name, value] : MetricColumns(ReadFile(file), file)) {
    auto column = std::find_if(table.metrics.begin(), table.metrics.end(),
                               [&](const SweepColumn& c) { return c.name == name; });
    if (column == table.metrics.end()) {
      column = table.metrics.insert(table.metrics.end(), {name, {}});
    }
    if (column->values.size() > row) {
      throw InputError(file, fmt::format("has {}, which another file of the run has too", name));
    }
    column->values.resize(row, kNothing);
    column->values.push_back(value);
  }
}

}  // namespace

SweepResults ReadRuns(const std::string& folder) {
  if (SweepDatabase::Exists(folder)) return ReadSweep(folder);
  RequireOneResult(folder);
  SweepResults table;
  table.folder = folder;
  for (const fs::path& run : RunFolders(folder)) {
    RequireOneResult(run.string());
    const int number = static_cast<int>(table.rows());
    table.runs.push_back(number);
    table.run_folders.push_back(run.string());
    table.points.push_back(0);
    table.failures.emplace_back();
    AddParameters(run, table);
    for (const std::string& file : ScoreFiles(run)) AddMetrics(file, table);
    for (SweepColumn& column : table.metrics) column.values.resize(table.rows(), kNothing);
  }
  DropUnstated(table);
  table.planned_runs = static_cast<int>(table.rows());
  return table;
}

}  // namespace depthgrid
