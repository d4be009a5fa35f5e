// A sweep as one table with a row per run, for statistics, comparisons and reports
// (docs/sweeps.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace depthgrid {

// A key of an axis, as in the sweep's file, such as mapper.fusion.gain.
struct SweepParameter {
  std::string key;
  std::vector<std::string> texts;  // YAML, one per row
  std::vector<double> numbers;     // the same as numbers; NaN where the text is not a number

  bool IsNumeric() const;
  // Seeds (seed, slam_seed ...) repeat a grid point instead of adding one.
  bool IsSeed() const;
};

struct SweepColumn {
  std::string name;            // path of metrics.json, such as trajectory.est.mean_euclidean_m
  std::vector<double> values;  // one per row; NaN where undefined or the run failed
};

// ", did you mean ...?" for an unknown column: the only column with `name` as a prefix, else those
// of its block ("trajectory.") whose last word begins with that of `name`, else the nearest by the
// whole name or the last word; empty if none is near.
std::string DidYouMeanColumn(const std::string& name, const std::vector<std::string>& names);

struct SweepResults {
  std::string folder;
  // title, version, instruction_set, sweep (the file), experiment (every effective key), ...
  std::map<std::string, std::string> environment;
  int planned_runs = 0;                    // the rows are those that are finished
  std::vector<int> runs;                   // the run's number in the whole sweep, ascending
  std::vector<std::string> run_folders;    // for runs that are not part of a sweep; else empty
  std::vector<int> points;                 // runs of one grid point differ only in their seeds
  std::vector<SweepParameter> parameters;  // in the order of the sweep's file
  std::vector<std::string> failures;       // why the run failed; empty when it did not
  std::vector<SweepColumn> metrics;
  std::vector<SweepColumn> times;  // run times, not reproducible

  std::size_t rows() const { return runs.size(); }
  bool HasParameter(const std::string& key) const;
  // Empty where the sweep's version did not write it.
  std::string EnvironmentText(const std::string& key) const;
  // The bits of all scores of a row. Runs with the same are one measurement, as where nothing in
  // them is random.
  std::vector<std::uint64_t> ScoreBits(std::size_t row) const;
  // Throw InputError, which suggests the nearest name, when there is none of that name.
  const SweepParameter& Parameter(const std::string& key) const;
  const std::vector<double>& Metric(const std::string& name) const;
};

// Whether an experiment's key is a seed.
bool IsSeedKey(const std::string& key);
// Whether its value may be a file name.
bool IsFileKey(const std::string& key);

// The database's name; a folder that contains one is a sweep's.
constexpr const char* kSweepDatabaseName = "results.sqlite";

// Throws InputError when the folder is not a sweep's.
SweepResults ReadSweep(const std::string& folder);

// results.csv: run, point, parameters, failed (0/1), metrics, times. Reproducible except for the
// times, whose names contain `time` or `_us`.
std::string ResultsCsv(const SweepResults& results);

}  // namespace depthgrid
