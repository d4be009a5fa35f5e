// The folder of a sweep: creating, resuming, finishing and merging it from parts.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/sweep_database.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// Locks a sweep's folder while a program works in it; for another program the constructor throws
// InputError.
class SweepLock {
 public:
  explicit SweepLock(const std::string& folder);
  ~SweepLock();
  SweepLock(const SweepLock&) = delete;
  SweepLock& operator=(const SweepLock&) = delete;

 private:
  int file_ = -1;
};

// For a folder without a sweep. Throws InputError when it contains another result with a
// report.html, or a file or folder that a sweep would overwrite or remove.
void RequireSweepNamesFree(const std::string& folder);

// Opens or creates the database in `folder`, which exists. Throws InputError when the folder
// contains another sweep, another part of it, or one of another version or instruction set, and
// (unless `force`) when it contains something else. A scene, path or movers may have changed if no
// run of them has succeeded; then the sweep is one of the changed ones, with a warning. With a
// `stop`, none may have failed either, as such runs stay.
SweepDatabase OpenOrCreateSweep(const std::string& folder, const SweepPlan& plan,
                                const Shard& shard, bool force, std::vector<std::string>& warnings);

// Opens the database of a sweep whose failed runs are not done again: nothing may have changed.
SweepDatabase OpenFinishedSweep(const std::string& folder, const SweepPlan& plan);

// Adds this program's build and number of parallel jobs to those of the programs that have worked
// on the sweep (`build` and `jobs` of the environment, "A, B"). Call it after planning failed runs
// again and before doing runs.
void NoteWork(SweepDatabase& database, int jobs);

// Warns if the runs are of several builds: one line.
std::optional<std::string> DoubtOfBuilds(const std::string& folder,
                                         const std::map<std::string, std::string>& environment);

// Writes results.csv beside the database, with the results so far.
void WriteResultsCsv(const SweepDatabase& database, const std::string& folder);

// Merges the parts of one sweep into `folder`, which contains no sweep yet, or the merge of these
// parts: then only results.csv is written, which a kill may have left out. Throws InputError when
// it contains another sweep, and when parts are missing, unfinished or given twice, or are of
// different sweeps, versions or instruction sets.
void MergeSweeps(const std::vector<std::string>& parts, const std::string& folder);

}  // namespace depthgrid
