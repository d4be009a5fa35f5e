#include "eval/sweep/sweep_reuse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "eval/statistics/score_names.h"
#include "eval/sweep/sweep_identity.h"
#include "eval/sweep/sweep_rooms.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr const char* kRemedy = "its runs cannot be taken over";

void RefuseStop(const std::string& folder, const SweepEnvironment& there, const SweepPlan& plan) {
  const auto again = there.find("again");
  const bool stops_there =
      again != there.end() && ("\n" + again->second).find("\nstop:") != std::string::npos;
  if (!stops_there && !plan.stop.Enabled()) return;
  throw InputError(stops_there ? folder : "--reuse",
                   fmt::format("{} sweep has a `stop`, whose decisions depend on all its seeds; {}",
                               stops_there ? "its" : "the", kRemedy));
}

void RequireSameAxes(const std::string& folder, const SweepResults& earlier,
                     const SweepPlan& plan) {
  std::set<std::string> there;
  for (const SweepParameter& parameter : earlier.parameters) there.insert(parameter.key);
  const std::set<std::string> here(plan.parameter_keys.begin(), plan.parameter_keys.end());
  if (there == here) return;
  throw InputError(folder, fmt::format("holds a sweep over {}, here it is {}; {}",
                                       fmt::join(there, ", "), fmt::join(here, ", "), kRemedy));
}

// What was done in a room that has changed since belongs to another sweep; runs that failed there
// are not taken.
void RequireSameRooms(const std::string& folder, const SweepEnvironment& there,
                      const SweepEnvironment& here, const SweepPlan& plan,
                      const std::vector<RunOutcome>& taken) {
  const auto rooms = there.find("rooms");
  if (rooms == there.end()) return;  // written by an earlier version
  const std::vector<std::string> known = LinesOfRooms(rooms->second);
  for (const SweptRoom& room : RoomsIn(here.at("rooms"), plan)) {
    if (std::find(known.begin(), known.end(), room.line) != known.end()) continue;
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](const RunOutcome& outcome) {
      return std::binary_search(room.runs.begin(), room.runs.end(), outcome.run);
    });
    if (!is_taken) continue;
    throw InputError(folder, fmt::format("holds runs in a scene, path or movers that have changed "
                                         "({}); {}",
                                         room.names, kRemedy));
  }
}

// The group of scores (IsGroupOfScores) that a score is in; empty if it is in none.
std::string GroupOf(const std::string& name) {
  for (std::size_t end = name.rfind('.'); end != std::string::npos && end > 0;
       end = name.rfind('.', end - 1)) {
    if (IsGroupOfScores(name.substr(0, end))) return name.substr(0, end);
  }
  return "";
}

// A run's metrics without those of groups that were undefined as a whole: other runs of the earlier
// sweep may have them, and a run done anew would have no such columns.
NamedValues MetricsOfRow(const SweepResults& results, std::size_t row) {
  std::set<std::string> defined = {""};
  for (const SweepColumn& metric : results.metrics) {
    if (!std::isnan(metric.values[row])) defined.insert(GroupOf(metric.name));
  }
  NamedValues values;
  for (const SweepColumn& metric : results.metrics) {
    if (!defined.contains(GroupOf(metric.name))) continue;
    values.emplace_back(metric.name, metric.values[row]);
  }
  return values;
}

NamedValues TimesOfRow(const SweepResults& results, std::size_t row) {
  NamedValues values;
  for (const SweepColumn& time : results.times) {
    if (!std::isnan(time.values[row])) values.emplace_back(time.name, time.values[row]);
  }
  return values;
}

// Its successful runs, by the values of `keys`.
std::map<std::vector<std::string>, std::size_t> RowsByValues(const SweepResults& results,
                                                             const std::vector<std::string>& keys) {
  std::map<std::vector<std::string>, std::size_t> rows;
  for (std::size_t row = 0; row < results.rows(); ++row) {
    if (!results.failures[row].empty()) continue;
    std::vector<std::string> values;
    for (const std::string& key : keys) values.push_back(results.Parameter(key).texts[row]);
    rows.try_emplace(std::move(values), row);
  }
  return rows;
}

}  // namespace

EarlierSweep EarlierSweepIn(const std::string& folder, const SweepPlan& plan) {
  const SweepResults results = ReadSweep(folder);
  const SweepEnvironment here = EnvironmentOf(plan, {});
  RequireSameSweep(folder, results.environment, here,
                   {"version", "instruction_set", "experiment", "given"}, kRemedy);
  RefuseStop(folder, results.environment, plan);
  RequireSameAxes(folder, results, plan);
  const auto rows = RowsByValues(results, plan.parameter_keys);
  EarlierSweep earlier;
  earlier.builds = ListIn(results.environment, "build");
  earlier.jobs = ListIn(results.environment, "jobs");
  for (const PlannedRun& run : plan.runs) {
    const auto found = rows.find(run.values);
    if (found == rows.end()) continue;
    earlier.outcomes.push_back(
        {run.run, "", MetricsOfRow(results, found->second), TimesOfRow(results, found->second)});
  }
  RequireSameRooms(folder, results.environment, here, plan, earlier.outcomes);
  return earlier;
}

int TakeOver(const EarlierSweep& earlier, SweepDatabase& database) {
  const std::vector<int> unfinished = database.UnfinishedRuns();  // ascending
  std::vector<RunOutcome> taken;
  for (const RunOutcome& outcome : earlier.outcomes) {
    const bool is_open = std::binary_search(unfinished.begin(), unfinished.end(), outcome.run);
    if (is_open) taken.push_back(outcome);
  }
  if (taken.empty()) return 0;
  const bool is_begun = !database.FinishedRuns().empty();
  const SweepEnvironment before = database.Environment();
  const auto note = [&](const std::string& key, const std::string& there) {
    database.Note(key, is_begun ? JoinedLists(ListIn(before, key), there) : there);
  };
  note("build", earlier.builds);
  note("jobs", earlier.jobs);
  database.Record(taken);
  return static_cast<int>(taken.size());
}

}  // namespace depthgrid
