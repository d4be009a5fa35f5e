// Runs that an earlier sweep has done already, for one with more seeds or other values of its axes.
#pragma once

#include <string>
#include <vector>

#include "eval/sweep/sweep_database.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// What a sweep may take from an earlier one.
struct EarlierSweep {
  std::vector<RunOutcome> outcomes;  // of successful runs, numbered as in the new sweep
  std::string builds;                // of the program that did them
  std::string jobs;                  // runs at a time
};

// The outcomes in `folder`, which may be unfinished or a part, of all runs of `plan` that it has.
// Throws InputError when it is no sweep's, when anything but the values of the axes differs (or the
// scene, path or movers of one of these runs have changed since), and when either sweep has a
// `stop`, whose decisions depend on all seeds.
EarlierSweep EarlierSweepIn(const std::string& folder, const SweepPlan& plan);

// Records the outcomes of all of these runs that `database` has not finished, and the builds and
// jobs that they are of. Returns the number of runs. Call it before NoteWork().
int TakeOver(const EarlierSweep& earlier, SweepDatabase& database);

}  // namespace depthgrid
