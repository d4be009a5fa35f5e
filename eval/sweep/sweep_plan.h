// A sweep's file, read and checked, and the runs it asks for.
//
// Seeds are always crossed with everything else: each grid point is run with each seed, so that
// for one seed all points see the same depth noise and the same errors of SLAM.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "eval/sweep/sweep_axes.h"
#include "eval/sweep/sweep_database.h"

namespace depthgrid {

enum class SweepMode {
  kGrid,    // every combination
  kZip,     // first values together, second values together, ...
  kRandom,  // `samples` points drawn from the axes
};

// A grid point needs no more seeds once the metric's mean over its first ones is this sure.
struct StopOptions {
  std::string metric;
  double width = 0.0;  // of the bootstrap 95 % interval of the mean
  int min_seeds = 5;

  bool Enabled() const { return !metric.empty(); }
  void Visit(OptionsVisitor& v);
};

// One of `count` equal parts of a sweep, for one machine each.
struct Shard {
  int index = 1;  // from 1
  int count = 1;
};

struct SweepPlan {
  std::string title;
  std::string sweep_text;       // what decides the runs, axes written out; the same for the same
  std::string again_text;       // a sweep's file for the same runs (SweepAgainText)
  std::string experiment_yaml;  // every effective key of the experiment
  // Of these the ones that a file or --set gives, a line each with its whole path: they stay when
  // an axis chooses another preset (slam.profile), which sets all others.
  std::string given_text;
  std::vector<SweepAxis> axes;
  std::vector<std::string> parameter_keys;  // of the axes, in the file's order
  StopOptions stop;
  std::string size_text;  // for people: "50 mapper.fusion.gain x 20 seed"
  std::vector<PlannedRun> runs;
  int point_count = 0;
  std::vector<std::string> warnings;  // what is likely not meant, a line each

  // What one run is; throws InputError for values that contradict each other.
  ExperimentOptions OptionsOf(const PlannedRun& run) const;
  // Where a key of the runs was given its value, an axis or a file.
  KeyPlaces PlaceOfKey() const;

  Config base;                                // the experiment with what the sweep sets in it
  std::string base_folder;                    // where its file names start
  std::map<std::string, std::string> places;  // of the keys that are given, for errors
};

// `set`: overrides from the command line. Throws InputError for anything wrong with the file or
// with any single value of an axis.
SweepPlan ReadSweepPlan(const std::string& path, const std::vector<std::string>& set);

// Runs of one group may differ in the mapper alone: they see the same scans. Numbers count up in
// the order in which groups first appear in `runs`.
std::vector<int> ScanGroups(const SweepPlan& plan);

// The runs of a shard: whole groups, or whole points where points may stop early.
std::vector<PlannedRun> RunsOf(const SweepPlan& plan, const Shard& shard);

}  // namespace depthgrid
