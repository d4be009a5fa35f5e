// The folder of a sweep: started, gone on with, finished, joined from parts.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eval/sweep/sweep_database.h"
#include "eval/sweep/sweep_plan.h"

namespace depthgrid {

// Held while a program works in a sweep's folder; another one is refused with an InputError.
class SweepLock {
 public:
  explicit SweepLock(const std::string& folder);
  ~SweepLock();
  SweepLock(const SweepLock&) = delete;
  SweepLock& operator=(const SweepLock&) = delete;

 private:
  int file_ = -1;
};

// Of a folder without a sweep: throws InputError when it holds another result with a report.html of
// its own, or a file or folder of a name that a sweep would overwrite or remove.
void RequireSweepNamesFree(const std::string& folder);

// The database in `folder`, which exists; made when there is none. Throws InputError when the
// folder holds another sweep, another part of it, or one of another version or instruction set, and
// when it holds something else (unless `force`).
SweepDatabase OpenOrCreateSweep(const std::string& folder, const SweepPlan& plan,
                                const Shard& shard, bool force);

// Before runs are done, and after those that failed are planned again: adds this program's build,
// and how many runs it does at a time, to those that have worked in it (`build` and `jobs` of the
// environment, "A, B").
void NoteWork(SweepDatabase& database, int jobs);

// Runs of several builds in one table: a line.
std::optional<std::string> DoubtOfBuilds(const std::string& folder,
                                         const std::map<std::string, std::string>& environment);

// results.csv beside the database, of what is known so far.
void WriteResultsCsv(const SweepDatabase& database, const std::string& folder);

// Joins the parts of one sweep into `folder`, which holds no sweep yet. Throws InputError when
// parts are missing, unfinished or doubled, or of another sweep, version or instruction set.
void MergeSweeps(const std::vector<std::string>& parts, const std::string& folder);

}  // namespace depthgrid
