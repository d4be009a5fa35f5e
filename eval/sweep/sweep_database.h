// The database file of a sweep: plan, results, failures and environment (docs/sweeps.md, "The
// database"). Every call is one transaction, so that after a kill each run is either complete or
// absent.
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
  std::vector<std::string> values;  // one per parameter key, YAML
};

using NamedValues = std::vector<std::pair<std::string, double>>;  // NaN: undefined

// The outcome of a finished run.
struct RunOutcome {
  int run = 0;
  std::string failure;  // the reason; empty when it succeeded
  NamedValues metrics;
  NamedValues times;
};

class SweepDatabase {
 public:
  static bool Exists(const std::string& folder);
  // Whether a killed Create() leaves a file of this name.
  static bool IsUnfinished(const std::string& file_name);
  // Afterwards the file contains either the whole plan and all `outcomes`, or does not exist.
  static SweepDatabase Create(const std::string& folder,
                              const std::map<std::string, std::string>& environment,
                              const std::vector<std::string>& parameter_keys,
                              const std::vector<PlannedRun>& plan,
                              const std::vector<RunOutcome>& outcomes = {});
  // Throws InputError when there is none or it is not a sweep's.
  static SweepDatabase Open(const std::string& folder);
  // The same for reading only; also works on a read-only disk or in a folder of another user.
  static SweepDatabase OpenToRead(const std::string& folder);
  SweepDatabase(SweepDatabase&&) noexcept;
  SweepDatabase& operator=(SweepDatabase&&) noexcept;
  ~SweepDatabase();

  std::map<std::string, std::string> Environment() const;
  // Sets the value of `key` in the environment.
  void Note(const std::string& key, const std::string& value);
  // Numbers of the runs that succeeded or failed, ascending.
  std::vector<int> FinishedRuns() const;
  // Numbers of the others, ascending.
  std::vector<int> UnfinishedRuns() const;
  // Numbers of both.
  std::vector<int> PlannedRuns() const;
  void Record(const RunOutcome& outcome);
  // All outcomes in one transaction.
  void Record(const std::vector<RunOutcome>& outcomes);
  // Plans failed runs again, because the cause may be gone. Returns their number.
  int PlanFailedAgain();
  // Removes these runs and their results from the plan.
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
