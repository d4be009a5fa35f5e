// The one file that holds a sweep: what was planned, what came out, what failed, where
// (docs/sweeps.md, "The database"). Every call is one transaction, so that a sweep killed at any
// moment has each run either whole or not at all.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "eval/sweep/sweep_results.h"

namespace depthgrid {

struct PlannedRun {
  int run = 0;
  int point = 0;
  std::vector<std::string> values;  // one a parameter key, YAML
};

using NamedValues = std::vector<std::pair<std::string, double>>;  // NaN: not defined

// What a finished run leaves.
struct RunOutcome {
  int run = 0;
  std::string failure;  // the reason; empty when it succeeded
  NamedValues metrics;
  NamedValues times;
};

class SweepDatabase {
 public:
  static bool Exists(const std::string& folder);
  // Whether a file of this name is what a Create() leaves that is killed.
  static bool IsUnfinished(const std::string& file_name);
  // All of the plan and of what is known already, or nothing, is in the file afterwards.
  static SweepDatabase Create(const std::string& folder,
                              const std::map<std::string, std::string>& environment,
                              const std::vector<std::string>& parameter_keys,
                              const std::vector<PlannedRun>& plan,
                              const std::vector<RunOutcome>& outcomes = {});
  // Throws InputError when there is none or it is something else.
  static SweepDatabase Open(const std::string& folder);
  // The same where it may not be written, on a read-only disk or in somebody else's folder; nothing
  // may be recorded then.
  static SweepDatabase OpenToRead(const std::string& folder);
  SweepDatabase(SweepDatabase&&) noexcept;
  SweepDatabase& operator=(SweepDatabase&&) noexcept;
  ~SweepDatabase();

  std::map<std::string, std::string> Environment() const;
  // Replaces what the environment says of `key`.
  void Note(const std::string& key, const std::string& value);
  // Numbers of the runs that are done or failed, ascending.
  std::vector<int> FinishedRuns() const;
  // Numbers of the others, ascending.
  std::vector<int> UnfinishedRuns() const;
  // Numbers of both.
  std::vector<int> PlannedRuns() const;
  void Record(const RunOutcome& outcome);
  // All outcomes in one transaction.
  void Record(const std::vector<RunOutcome>& outcomes);
  // Failed runs are planned again: what made them fail may be gone. How many they were.
  int PlanFailedAgain();
  // Takes these runs out of the plan, with what they gave.
  void Drop(const std::vector<int>& runs);
  // One metric of some runs, in their order; NaN where it is missing.
  std::vector<double> MetricOf(const std::string& name, const std::vector<int>& runs) const;
  SweepResults Results() const;

 private:
  struct Impl;
  explicit SweepDatabase(std::unique_ptr<Impl> impl);
  static SweepDatabase Opened(const std::string& folder, const std::string& name, int flags);
  std::unique_ptr<Impl> impl_;
};

}  // namespace depthgrid
