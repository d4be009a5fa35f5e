// A sweep as one table, a row a run: what statistics, comparisons and reports read
// (docs/sweeps.md).
#pragma once

#include <map>
#include <string>
#include <vector>

namespace depthgrid {

// What was varied: one axis key as the sweep's file has it, such as mapper.fusion.gain.
struct SweepParameter {
  std::string key;
  std::vector<std::string> texts;  // YAML, one a row
  std::vector<double> numbers;     // the same; NaN where the text is no number

  bool IsNumeric() const;
  // Axes that repeat a grid point instead of making another: seed, slam_seed ...
  bool IsSeed() const;
};

struct SweepColumn {
  std::string name;            // path of metrics.json, such as trajectory.est.mean_euclidean_m
  std::vector<double> values;  // one a row; NaN where not defined or the run failed
};

// ", did you mean ...?" of a column's name: the only one that it begins, else those of its block
// ("trajectory.") whose last word its own begins, else the nearest, by the whole name or by the
// last word; empty where none is near.
std::string DidYouMeanColumn(const std::string& name, const std::vector<std::string>& names);

struct SweepResults {
  std::string folder;
  // title, version, instruction_set, sweep (the file), experiment (every effective key), ...
  std::map<std::string, std::string> environment;
  int planned_runs = 0;                    // rows are the finished ones of these
  std::vector<int> runs;                   // the run's number in the whole sweep, ascending
  std::vector<std::string> run_folders;    // of runs that are no sweep's; else empty
  std::vector<int> points;                 // runs of one grid point differ only in their seeds
  std::vector<SweepParameter> parameters;  // in the order of the sweep's file
  std::vector<std::string> failures;       // why the run failed; empty when it did not
  std::vector<SweepColumn> metrics;
  std::vector<SweepColumn> times;  // everything about speed; never the same twice

  std::size_t rows() const { return runs.size(); }
  // Throw InputError with the nearest name when there is none of that name.
  const SweepParameter& Parameter(const std::string& key) const;
  const std::vector<double>& Metric(const std::string& name) const;
};

// Whether an experiment's key is a seed.
bool IsSeedKey(const std::string& key);
// Whether its value may be a file's name.
bool IsFileKey(const std::string& key);

// The database's name in a sweep's folder; a folder is a sweep's when it holds one.
constexpr const char* kSweepDatabaseName = "results.sqlite";

// Throws InputError when the folder is no sweep's.
SweepResults ReadSweep(const std::string& folder);

// results.csv: run, point, parameters, failed (0/1), metrics, times. Depends on the sweep alone
// but for the times, each of which has `time` or `_us` in its name.
std::string ResultsCsv(const SweepResults& results);

}  // namespace depthgrid
