#include "eval/sweep/sweep_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "eval/output/build_id.h"
#include "eval/output/result_files.h"
#include "eval/sweep/sweep_identity.h"
#include "eval/sweep/sweep_rooms.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "/.lock";

using Environment = SweepEnvironment;

// A folder with nothing but an incomplete plan of a killed sweep counts as empty.
bool IsEmptyFolder(const std::string& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const auto& entry) {
                       const std::string name = entry.path().filename().string();
                       return "/" + name == kLockName || SweepDatabase::IsUnfinished(name);
                     });
}

std::vector<RunOutcome> OutcomesOf(const SweepResults& results) {
  std::vector<RunOutcome> outcomes(results.rows());
  for (std::size_t row = 0; row < results.rows(); ++row) {
    outcomes[row].run = results.runs[row];
    outcomes[row].failure = results.failures[row];
    for (const SweepColumn& metric : results.metrics) {
      outcomes[row].metrics.emplace_back(metric.name, metric.values[row]);
    }
    for (const SweepColumn& time : results.times) {
      outcomes[row].times.emplace_back(time.name, time.values[row]);
    }
  }
  return outcomes;
}

std::vector<PlannedRun> PlanOf(const SweepResults& results) {
  std::vector<PlannedRun> plan(results.rows());
  for (std::size_t row = 0; row < results.rows(); ++row) {
    plan[row].run = results.runs[row];
    plan[row].point = results.points[row];
    for (const SweepParameter& parameter : results.parameters) {
      plan[row].values.push_back(parameter.texts[row]);
    }
  }
  return plan;
}

Shard PartIn(const std::string& folder, const Environment& environment) {
  const auto text = environment.find("shard");
  if (text == environment.end()) {
    throw InputError(
        folder,
        fmt::format("does not say which part it is: its `shard` is missing, {}", kShardRule));
  }
  if (const auto shard = ParseShard(text->second)) return *shard;
  throw InputError(folder, fmt::format("its `shard` is '{}', {}", text->second, kShardRule));
}

// Throws unless the parts are all of 1/N .. N/N, each once.
void RequireWhole(const std::vector<std::string>& folders, const std::vector<SweepResults>& parts) {
  std::map<int, std::string> seen;
  int count = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Shard shard = PartIn(folders[i], parts[i].environment);
    if (count != 0 && shard.count != count) {
      throw InputError(folders[i], fmt::format("is one of {} parts, {} is one of {}", shard.count,
                                               folders[0], count));
    }
    count = shard.count;
    const auto [there, is_new] = seen.try_emplace(shard.index, folders[i]);
    if (!is_new) {
      throw InputError(folders[i],
                       fmt::format("is part {}, as {} is", ShardText(shard), there->second));
    }
  }
  for (int index = 1; index <= count; ++index) {
    if (seen.contains(index)) continue;
    throw InputError("--merge", "part " + ShardText({index, count}) + " is missing");
  }
}

// A sweep's finished runs, as far as tables that name their columns in another order are equal.
struct FinishedRun {
  int point = 0;
  std::string failure;
  std::map<std::string, std::string> parameters;
  std::map<std::string, double> values;  // of metrics and times, where defined

  bool operator==(const FinishedRun&) const = default;
};

void AddRuns(const SweepResults& results, std::map<int, FinishedRun>& runs) {
  for (std::size_t row = 0; row < results.rows(); ++row) {
    FinishedRun& run = runs[results.runs[row]];
    run.point = results.points[row];
    run.failure = results.failures[row];
    for (const SweepParameter& parameter : results.parameters) {
      run.parameters[parameter.key] = parameter.texts[row];
    }
    for (const auto* columns : {&results.metrics, &results.times}) {
      for (const SweepColumn& column : *columns) {
        if (!std::isnan(column.values[row])) run.values[column.name] = column.values[row];
      }
    }
  }
}

// What to do about a folder that holds another sweep, and where only the values of the axes differ,
// so that runs can be taken over.
struct OtherSweepRemedies {
  const char* of_any;
  const char* of_axes;
};

void RequireThisSweep(const std::string& folder, const Environment& there, const Environment& here,
                      const OtherSweepRemedies& remedies) {
  for (const std::string& respect : WhatMakesASweep()) {
    RequireSameSweep(folder, there, here, {respect},
                     respect == "sweep" ? remedies.of_axes : remedies.of_any);
  }
}

constexpr OtherSweepRemedies kAnotherFolder = {
    "choose another folder, or remove this one",
    "choose another folder, where --reuse takes over its runs, or remove this one"};

// Whether a run of the sweep counts in its table as it is. Where a `stop` looks at what failed,
// that is not done anew.
bool HasRunThatStays(const SweepResults& results, const std::vector<int>& runs, bool stops) {
  for (std::size_t row = 0; row < results.rows(); ++row) {
    if (!stops && !results.failures[row].empty()) continue;
    if (std::find(runs.begin(), runs.end(), results.runs[row]) != runs.end()) return true;
  }
  return false;
}

// The names of the rooms that have changed, if none of them has a run that stays in the table.
std::vector<std::string> RoomsToDoAnew(const SweepPlan& plan, const SweepDatabase& database,
                                       const Environment& there, const Environment& here) {
  const auto text = there.find("rooms");
  if (text == there.end()) return {};
  // Line by line, as files of one name in several folders may have each other's content now.
  const std::vector<std::string> known = LinesOfRooms(text->second);
  const std::vector<SweptRoom> rooms = RoomsIn(here.at("rooms"), plan);
  if (known.size() != rooms.size()) return {};
  const SweepResults results = database.Results();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (rooms[i].line == known[i]) continue;
    if (HasRunThatStays(results, rooms[i].runs, plan.stop.Enabled())) return {};
    names.push_back(rooms[i].names);
  }
  return names;
}

// The folder's sweep with what has changed in rooms of which no run counts yet.
SweepDatabase GoneOnWith(const std::string& folder, const SweepPlan& plan, const Environment& here,
                         std::vector<std::string>& warnings) {
  SweepDatabase database = SweepDatabase::Open(folder);
  Environment there = database.Environment();
  const std::vector<std::string> anew = RoomsToDoAnew(plan, database, there, here);
  if (!anew.empty()) there["rooms"] = here.at("rooms");
  RequireThisSweep(folder, there, here, kAnotherFolder);
  RequireSameSweep(folder, there, here, {"shard"}, kAnotherFolder.of_any);
  if (anew.empty()) return database;
  database.Note("scene_names", here.at("scene_names"));
  database.Note("rooms", here.at("rooms"));  // last: until then a killed program begins again
  warnings.push_back(
      fmt::format("{}: a scene, path or movers have changed ({}); as no run there had succeeded, "
                  "the sweep goes on with them as they are now",
                  folder, fmt::join(anew, "; ")));
  return database;
}

// Whether `whole` is what merging the parts gives, whose environment that is.
bool IsMergeOf(const SweepResults& whole, const std::vector<SweepResults>& parts,
               const Environment& environment) {
  std::vector<std::string> respects = WhatMakesASweep();
  respects.emplace_back("shard");
  for (const std::string& respect : respects) {
    if (ListIn(whole.environment, respect) != ListIn(environment, respect)) return false;
  }
  std::map<int, FinishedRun> of_whole, of_parts;
  AddRuns(whole, of_whole);
  for (const SweepResults& part : parts) AddRuns(part, of_parts);
  return of_whole == of_parts && of_whole.size() == static_cast<std::size_t>(whole.planned_runs);
}

// The environment of the whole.
Environment JoinedEnvironment(const std::vector<SweepResults>& parts) {
  Environment environment = parts[0].environment;
  environment.erase("schema");
  for (const std::string key : {"build", "jobs"}) {
    environment[key] = ListIn(parts[0].environment, key);
    for (const SweepResults& part : parts) {
      environment[key] = JoinedLists(environment[key], ListIn(part.environment, key));
    }
  }
  environment["shard"] = ShardText({});
  return environment;
}

}  // namespace

void NoteWork(SweepDatabase& database, int jobs) {
  if (database.UnfinishedRuns().empty()) return;
  const bool is_begun = !database.FinishedRuns().empty();
  const Environment before = database.Environment();
  const auto note = [&](const std::string& key, const std::string& here) {
    database.Note(key, is_begun ? JoinedLists(ListIn(before, key), here) : here);
  };
  note("build", BuildId());
  note("jobs", std::to_string(jobs));
}

std::optional<std::string> DoubtOfBuilds(const std::string& folder,
                                         const std::map<std::string, std::string>& environment) {
  const std::string builds = ListIn(environment, "build");
  if (builds.find(',') == std::string::npos) return std::nullopt;
  return fmt::format(
      "{}: its runs are of several builds of the program ({}), which may give other numbers",
      folder, builds);
}

void RequireSweepNamesFree(const std::string& folder) {
  RequireNoOtherResult(folder, ResultKind::kSweep);
  std::vector<std::string> names = {"results.csv",      "report.html",  "experiment.yaml",
                                    "sweep_again.yaml", "progress.txt", "cache"};
  // A sweep on Slurm has these two and its lock before it has a database.
  if (!fs::exists(folder + kLockName)) names.insert(names.end(), {"slurm", "shards"});
  for (const std::string& name : names) {
    const fs::path file = fs::path(folder) / name;
    if (!fs::exists(fs::symlink_status(file))) continue;
    throw InputError(
        file.string(),
        "is there already and belongs to no sweep; choose another folder for the sweep");
  }
}

SweepLock::SweepLock(const std::string& folder) {
  const std::string path = folder + kLockName;
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) {
    throw InputError(folder, "cannot be written: " + std::generic_category().message(errno));
  }
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    ::close(file_);
    throw InputError(folder, "another program is working on this sweep");
  }
}

SweepLock::~SweepLock() { ::close(file_); }

SweepDatabase OpenOrCreateSweep(const std::string& folder, const SweepPlan& plan,
                                const Shard& shard, bool force,
                                std::vector<std::string>& warnings) {
  const Environment here = EnvironmentOf(plan, shard);
  if (SweepDatabase::Exists(folder)) return GoneOnWith(folder, plan, here, warnings);
  if (!force && !IsEmptyFolder(folder)) {
    throw InputError(folder, "is not empty and holds no sweep; choose another folder, or --force");
  }
  return SweepDatabase::Create(folder, here, plan.parameter_keys, RunsOf(plan, shard));
}

SweepDatabase OpenFinishedSweep(const std::string& folder, const SweepPlan& plan) {
  const Environment here = EnvironmentOf(plan, {});
  SweepDatabase database = SweepDatabase::Open(folder);
  RequireThisSweep(folder, database.Environment(), here, kAnotherFolder);
  RequireSameSweep(folder, database.Environment(), here, {"shard"}, kAnotherFolder.of_any);
  return database;
}

void WriteResultsCsv(const SweepDatabase& database, const std::string& folder) {
  WriteFile((fs::path(folder) / "results.csv").string(), ResultsCsv(database.Results()));
}

void MergeSweeps(const std::vector<std::string>& folders, const std::string& target) {
  std::vector<SweepResults> parts;
  for (const std::string& folder : folders) {
    parts.push_back(ReadSweep(folder));
    const SweepResults& part = parts.back();
    RequireThisSweep(
        folder, part.environment, parts[0].environment,
        {"parts are of one sweep",
         "parts are of one sweep; a sweep of all values with a --reuse for each folder "
         "joins several"});
    const auto missing = part.planned_runs - static_cast<int>(part.rows());
    if (missing > 0) {
      throw InputError(folder, fmt::format("is not finished: {} of {} runs are missing", missing,
                                           part.planned_runs));
    }
  }
  RequireWhole(folders, parts);
  const Environment environment = JoinedEnvironment(parts);
  if (SweepDatabase::Exists(target)) {
    const SweepDatabase there = SweepDatabase::Open(target);
    if (!IsMergeOf(there.Results(), parts, environment)) {
      throw InputError(target, "holds a sweep already, which is not the whole of these parts");
    }
    return WriteResultsCsv(there, target);
  }
  std::vector<PlannedRun> plan;
  std::vector<RunOutcome> outcomes;
  for (const SweepResults& part : parts) {
    for (PlannedRun& run : PlanOf(part)) plan.push_back(std::move(run));
    for (RunOutcome& outcome : OutcomesOf(part)) outcomes.push_back(std::move(outcome));
  }
  std::vector<std::string> keys;
  for (const SweepParameter& parameter : parts[0].parameters) keys.push_back(parameter.key);
  const SweepDatabase merged = SweepDatabase::Create(target, environment, keys, plan, outcomes);
  WriteResultsCsv(merged, target);
}

}  // namespace depthgrid
