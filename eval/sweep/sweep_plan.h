// Reads and checks a sweep's file and lists its runs.
//
// Seeds are always crossed with everything else: each grid point is run with each seed, so that for
// one seed all points see the same depth noise and the same errors of SLAM.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "eval/sweep/shard.h"
#include "eval/sweep/sweep_axes.h"
#include "eval/sweep/sweep_database.h"

namespace depthgrid {

enum class SweepMode {
  kGrid,    // every combination
  kZip,     // first values together, second values together, ...
  kRandom,  // `samples` points drawn from the axes
};

// A grid point gets no more seeds once the metric's mean over the first ones is this accurate.
struct StopOptions {
  std::string metric;
  double width = 0.0;  // of the bootstrap 95 % interval of the mean
  int min_seeds = 5;

  bool Enabled() const { return !metric.empty(); }
  void Visit(OptionsVisitor& v);
};

struct SweepPlan {
  std::string title;
  std::string sweep_text;  // all that determines the runs, with axes listed; equal for equal sweeps
  std::string again_text;  // a sweep's file that gives the same runs (SweepAgainText)
  std::string experiment_yaml;  // every effective key of the experiment
  // Those of these keys that a file or --set gives, one line each with the full path. They remain
  // when an axis selects another preset (slam.profile), which sets all others.
  std::string given_text;
  std::vector<SweepAxis> axes;
  std::vector<std::string> parameter_keys;  // of the axes, in the file's order
  StopOptions stop;
  std::string size_text;  // for display: "50 mapper.fusion.gain x 20 seed"
  std::vector<PlannedRun> runs;
  int point_count = 0;
  std::vector<std::string> warnings;  // one line each

  // The options of one run. Throws InputError for values that contradict each other.
  ExperimentOptions OptionsOf(const PlannedRun& run) const;
  // Where a key of the runs got its value: an axis or a file.
  KeyPlaces PlaceOfKey() const;

  Config base;                                // the experiment with the sweep's changes
  std::string base_folder;                    // to which its file names are relative
  std::map<std::string, std::string> places;  // of the given keys, for error messages
};

// `set`: overrides from the command line. Throws InputError for anything wrong with the file or
// with any single value of an axis.
SweepPlan ReadSweepPlan(const std::string& path, const std::vector<std::string>& set);

// The group of each run. Runs of one group differ only in the mapper and have the same scans.
// Groups are numbered in the order in which they first appear in `runs`.
std::vector<int> ScanGroups(const SweepPlan& plan);

// The runs of a shard: whole groups, or whole points if points may stop early.
std::vector<PlannedRun> RunsOf(const SweepPlan& plan, const Shard& shard);

}  // namespace depthgrid
