#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/cli/interrupts.h"
#include "eval/cli/locked_sweep.h"
#include "eval/compare/sweep_report.h"
#include "eval/experiment/shipped.h"
#include "eval/files/shell_word.h"
#include "eval/output/output_folder.h"
#include "eval/sweep/scan_maker.h"
#include "eval/sweep/slurm.h"
#include "eval/sweep/sweep_cache.h"
#include "eval/sweep/sweep_engine.h"
#include "eval/sweep/sweep_folder.h"
#include "eval/sweep/sweep_progress.h"
#include "eval/sweep/sweep_reuse.h"
#include "eval/sweep/sweep_rooms.h"
#include "mapper/core/error.h"
#include "mapper/core/usable_threads.h"
#include "mapper/io/end_task.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

Shard ShardOf(const std::string& text) {
  if (text.empty()) return {};
  if (const std::optional<Shard> shard = ParseShard(text)) return *shard;
  throw InputError("--shard", fmt::format("is '{}', {}", text, kShardRule));
}

std::string DurationText(double seconds) {
  constexpr double kMinute = 60.0;
  constexpr double kHour = 3600.0;
  if (seconds < kMinute) return fmt::format("{:.0f} s", seconds);
  if (seconds < kHour) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.1f} h", seconds / kHour);
}

// Which runs of a plan are to be done here.
struct WorkHere {
  std::vector<int> runs;
  std::size_t planned = 0;  // these and those that are finished
  int failed = 0;           // tried again
  int taken = 0;            // taken over from an earlier sweep
  std::vector<std::string> taken_from;
};

void Announce(const SweepPlan& plan, const WorkHere& work, const SweepContext& context) {
  const std::vector<int>& runs = work.runs;
  fmt::print("{}: {}, {}", plan.title, Counted(plan.runs.size(), "run"), plan.size_text);
  if (work.planned < plan.runs.size()) fmt::print("; {} of them here", work.planned);
  const std::size_t done = work.planned - runs.size() - static_cast<std::size_t>(work.taken);
  if (done > 0) fmt::print("; {} done already", done);
  if (!work.taken_from.empty()) {
    fmt::print("; {} taken from {}", work.taken, fmt::join(work.taken_from, ", "));
  }
  if (work.failed > 0) fmt::print("; {} failed and tried again", work.failed);
  fmt::print("\n");
  std::fflush(stdout);
  if (runs.empty()) return;
  const SweepEstimate estimate = EstimateSweep(plan, runs, context);
  if (estimate.cpu_s > 0.0) {
    fmt::print("about {} with {} at a time, {} of scans\n",
               DurationText(estimate.cpu_s / UsableThreads(context.threads)), context.threads,
               Counted(estimate.scan_sets, "different set"));
  } else {
    fmt::print("the first points fail: {}\n", estimate.failure);
  }
  std::fflush(stdout);
}

// Of a sweep that begins.
WorkHere WorkAnew(const SweepPlan& plan, const SweepArguments& arguments,
                  const std::vector<EarlierSweep>& earlier) {
  WorkHere work;
  work.taken_from = arguments.reuse;
  std::set<int> taken;
  for (const EarlierSweep& sweep : earlier) {
    for (const RunOutcome& outcome : sweep.outcomes) taken.insert(outcome.run);
  }
  for (const PlannedRun& run : RunsOf(plan, ShardOf(arguments.shard))) {
    ++work.planned;
    if (taken.contains(run.run)) {
      ++work.taken;
    } else {
      work.runs.push_back(run.run);
    }
  }
  return work;
}

void Summarise(const SweepResults& results) {
  std::size_t failed = 0;
  std::string reason;
  for (const std::string& failure : results.failures) {
    if (failure.empty()) continue;
    if (failed++ == 0) reason = failure;
  }
  fmt::print("{} in {}/results.csv\n", Counted(results.rows(), "run"), results.folder);
  if (results.rows() > 0) {
    WriteSweepReport(results.folder, {results.folder});
    SayReport(results.folder);
  }
  if (failed == 0) return;
  const std::string message =
      fmt::format("{} of {} failed, the first: {}", failed, Counted(results.rows(), "run"), reason);
  if (failed == results.rows()) throw std::runtime_error(message);
  Warn({message});
}

// --merge takes no other options, because the parts have all settings.
void RequireMergeAlone(const SweepArguments& arguments) {
  if (!arguments.sweep.empty()) {
    throw InputError("--merge", "takes the sweep from the parts, '" + arguments.sweep +
                                    "' is one argument too many");
  }
  const auto refuse_if = [](bool given, const std::string& option) {
    if (given) throw InputError(option, "has no meaning with --merge, which runs nothing");
  };
  refuse_if(arguments.dry_run, "--dry-run");
  refuse_if(!arguments.shard.empty(), "--shard");
  refuse_if(!arguments.reuse.empty(), "--reuse");
  refuse_if(!arguments.common.set.empty(), "--set");
  refuse_if(arguments.executor == "slurm", "--executor");
  refuse_if(!arguments.slurm_options.empty(), "--slurm-options");
  refuse_if(arguments.slurm_tasks != 0, "--slurm-tasks");
  refuse_if(arguments.jobs != 0, "--jobs");
  refuse_if(!arguments.common.cache.empty(), "--cache");
  refuse_if(arguments.common.no_cache, "--no-cache");
}

void Merge(const SweepArguments& arguments) {
  RequireMergeAlone(arguments);
  const std::string& output = arguments.common.output;
  const LockedSweep folder(output, arguments.common.force);
  MergeSweeps(arguments.merge, output);
  const SweepResults results = ReadSweep(output);
  if (const auto doubt = DoubtOfBuilds(output, results.environment)) Warn({*doubt});
  Summarise(results);
}

// Writes a table of the results so far. Reopens the database because it may run in a thread of its
// own.
void TabulateKnown(const std::string& folder) {
  try {
    const SweepDatabase database = SweepDatabase::Open(folder);
    WriteResultsCsv(database, folder);
    const std::size_t planned = database.PlannedRuns().size();
    fmt::print(stderr, "depthgrid: {} of {} done, in {}/results.csv; the same command goes on\n",
               planned - database.UnfinishedRuns().size(), Counted(planned, "run"), folder);
  } catch (const std::exception&) {  // written at the next start
  }
}

// What the `--reuse` name, in their order.
std::vector<EarlierSweep> EarlierOf(const SweepArguments& arguments, const SweepPlan& plan) {
  std::vector<EarlierSweep> earlier;
  for (const std::string& folder : arguments.reuse) {
    std::error_code error;  // as long as there is no output folder
    if (fs::equivalent(folder, arguments.common.output, error)) {
      throw InputError("--reuse " + folder,
                       "is the output's own folder, whose runs stay without it");
    }
    earlier.push_back(EarlierSweepIn(folder, plan));
  }
  return earlier;
}

// Closes the database before it returns.
SweepResults DoUnfinishedRuns(const SweepArguments& arguments, const SweepPlan& plan,
                              const std::vector<EarlierSweep>& earlier, SweepContext context) {
  const std::string& output = arguments.common.output;
  std::vector<std::string> changes;
  SweepDatabase database =
      OpenOrCreateSweep(output, plan, ShardOf(arguments.shard), arguments.common.force, changes);
  Warn(changes);
  // With `stop`, their results also affected the number of seeds.
  const std::vector<int> never_done = database.UnfinishedRuns();
  if (!plan.stop.Enabled()) database.PlanFailedAgain();
  int taken = 0;
  for (const EarlierSweep& sweep : earlier) taken += TakeOver(sweep, database);
  const std::vector<int> to_do = database.UnfinishedRuns();
  const auto failed = std::count_if(to_do.begin(), to_do.end(), [&](int run) {
    return !std::binary_search(never_done.begin(), never_done.end(), run);
  });
  NoteWork(database, context.threads);
  if (const auto doubt = DoubtOfBuilds(output, database.Environment())) Warn({*doubt});
  Announce(plan,
           {to_do, database.PlannedRuns().size(), static_cast<int>(failed), taken, arguments.reuse},
           context);
  ProgressBar bar("runs");
  ProgressFile file(output);
  context.progress = [&](int done, int total) {
    bar.Show(done, total);
    file.Note({done, total});
  };
  std::vector<std::string> doubts;
  {
    const EndTask write_table([&output] {
      if (InterruptExitCode()) TabulateKnown(output);
    });
    doubts = DoRuns(plan, database, context);
  }
  bar.Clear();
  Warn(doubts);
  WriteResultsCsv(database, output);
  return database.Results();
}

// What `do_runs` returns, with rendered depth and scans kept in `cache`. When the disk is full, a
// cache that is the sweep's `own` makes room for the results: it is removed, and the other runs are
// done without.
SweepResults WithCache(const std::string& cache, bool own,
                       const std::function<SweepResults(const std::string& cache)>& do_runs) {
  try {
    return do_runs(cache);
  } catch (const DiskFullError& error) {
    if (!own || !fs::exists(cache) || InterruptExitCode()) throw;
    Warn({fmt::format("{}; {} is removed, and the sweep goes on without it", error.what(), cache)});
    RemoveSweepCache(cache);
    return do_runs("");
  }
}

// Runs the sweep in its folder, which exists and is locked.
void SweepIn(const std::string& output, const SweepArguments& arguments, const SweepPlan& plan,
             const std::vector<EarlierSweep>& earlier, SweepContext context) {
  // By default rendered depth and scans are cached in the sweep's folder, so that they survive a
  // kill.
  const bool own_cache = context.cache_folder.empty() && !arguments.common.no_cache;
  if (own_cache) context.cache_folder = output + "/cache";
  const SweepResults results = WithCache(context.cache_folder, own_cache, [&](auto cache) {
    context.cache_folder = cache;
    return DoUnfinishedRuns(arguments, plan, earlier, context);
  });
  if (own_cache) RemoveSweepCache(output + "/cache");  // first: it may fill the disk
  ProgressFile(output).NoteNow({results.planned_runs, results.planned_runs});
  Summarise(results);
}

void SweepHere(const SweepArguments& arguments, const SweepPlan& plan,
               const std::vector<EarlierSweep>& earlier) {
  const std::string& output = arguments.common.output;
  ShardOf(arguments.shard);  // checked before the folder is created
  const LockedSweep folder(output, arguments.common.force);
  SweepContext context;
  context.threads = ThreadsOr(arguments.jobs);
  context.cache_folder = CacheFolder(arguments.common);
  try {
    SweepIn(output, arguments, plan, earlier, context);
  } catch (const DiskFullError& error) {
    if (context.cache_folder.empty()) throw;
    // Other sweeps may use it.
    throw DiskFullError(
        fmt::format("{}; if its cache {} takes the room, remove that or choose "
                    "another with --cache DIR, or --no-cache",
                    error.what(), context.cache_folder));
  } catch (const std::exception&) {
    // If the folder was removed meanwhile, errors are not the user's mistake.
    if (folder.IsThere()) throw;
    throw std::runtime_error(output + ": was removed while the sweep was at work in it");
  }
}

// The command of one part, whose number the task's shell inserts.
std::string PartCommand(const SweepArguments& arguments, const std::string& sweep_file,
                        const std::string& folder, int parts) {
  const auto absolute = [](const std::string& path) {
    return fs::absolute(path).lexically_normal().string();
  };
  std::string command = ShellWord(fs::read_symlink("/proc/self/exe").string()) + " sweep " +
                        ShellWord(absolute(sweep_file));
  command +=
      fmt::format(" --shard \"$SLURM_ARRAY_TASK_ID/{}\" -j {}", parts, std::max(1, arguments.jobs));
  command += " -o " + ShellWord(folder) + "/shards/\"$SLURM_ARRAY_TASK_ID\"";
  for (const std::string& set : arguments.common.set) command += " --set " + ShellWord(set);
  const std::string cache = CacheFolder(arguments.common);
  if (!cache.empty()) command += " --cache " + ShellWord(absolute(cache));
  for (const std::string& earlier : arguments.reuse) {
    command += " --reuse " + ShellWord(absolute(earlier));
  }
  if (arguments.common.no_cache) command += " --no-cache";
  return command;
}

constexpr int kMostParts = 1000;  // Slurm's default MaxArraySize is 1001

// As many parts as have enough work each: an empty task costs Slurm about a second.
int PartsFor(const SweepArguments& arguments, const SweepPlan& plan, double cpu_s) {
  constexpr double kLeastTaskS = 30.0;
  const std::vector<int> groups = ScanGroups(plan);
  const int units =
      plan.stop.Enabled() ? plan.point_count : *std::max_element(groups.begin(), groups.end()) + 1;
  const double tasks = cpu_s / std::max(1, arguments.jobs) / kLeastTaskS;
  const int wanted = arguments.slurm_tasks > 0
                         ? arguments.slurm_tasks
                         : static_cast<int>(std::min<double>(tasks, kMostParts));
  return std::clamp(wanted, 1, std::min(units, kMostParts));
}

// The number of parts remains that of the sweep's first start.
int PartsIn(const std::string& folder, const std::function<int()>& otherwise) {
  const std::string path = folder + "/shards/parts.txt";
  if (fs::exists(path)) {
    const std::string text = ReadFile(path);
    const auto parts = ParseNumber(text.substr(0, text.find('\n')));
    if (!parts || *parts < 1 || *parts > kMostParts || *parts != std::floor(*parts)) {
      throw InputError(path, fmt::format("is '{}', must be a whole number from 1 to {}",
                                         text.substr(0, text.find('\n')), kMostParts));
    }
    return static_cast<int>(*parts);
  }
  const int parts = otherwise();
  fs::create_directories(folder + "/shards");
  WriteFile(path, fmt::format("{}\n", parts));
  return parts;
}

void SweepOnSlurm(const SweepArguments& arguments, const SweepPlan& plan,
                  const std::string& sweep_file) {
  if (!arguments.shard.empty()) throw InputError("--shard", "is what --executor slurm decides");
  const std::string output = fs::absolute(arguments.common.output).lexically_normal().string();
  const LockedSweep folder(output, arguments.common.force);
  SweepContext context;
  context.cache_folder = CacheFolder(arguments.common);
  SlurmJob job;
  job.title = plan.title;
  job.folder = output;
  job.options = arguments.slurm_options;
  job.cpus_per_task = std::max(1, arguments.jobs);
  job.parts = PartsIn(output, [&] {
    std::vector<int> runs;
    for (const PlannedRun& run : plan.runs) runs.push_back(run.run);
    return PartsFor(arguments, plan, EstimateSweep(plan, runs, context).cpu_s);
  });
  job.command = PartCommand(arguments, sweep_file, output, job.parts);
  fmt::print("{}: {}, {}; {}\n", plan.title, Counted(plan.runs.size(), "run"), plan.size_text,
             Counted(job.parts, "task"));
  std::fflush(stdout);
  ProgressBar bar("runs");
  job.progress = [&](int done, int) { bar.Show(done, static_cast<int>(plan.runs.size())); };
  if (!SweepDatabase::Exists(output)) {
    RunOnSlurm(job);
    std::vector<std::string> parts;
    for (int part = 1; part <= job.parts; ++part) parts.push_back(PartFolder(output, part));
    MergeSweeps(parts, output);
  }
  bar.Clear();
  // Throws if it is another sweep.
  const SweepDatabase database = OpenFinishedSweep(output, plan);
  WriteResultsCsv(database, output);  // one killed after merging may have left none
  Summarise(database.Results());
}

}  // namespace

void Sweep(const SweepArguments& arguments) {
  if (!arguments.merge.empty()) return Merge(arguments);
  if (arguments.sweep.empty()) throw InputError("sweep", "name a shipped sweep or a YAML file");
  const std::string file = ResolveName(arguments.sweep, ShippedKind::kSweep);
  const SweepPlan plan = ReadSweepPlan(file, arguments.common.set);
  RequireRooms(plan);
  RequireCacheElsewhere(arguments.common);
  RequireUsableCache(CacheFolder(arguments.common));
  const std::vector<EarlierSweep> earlier = EarlierOf(arguments, plan);
  Warn(plan.warnings);
  Warn(DoubtsOfPaths(plan, ThreadsOr(arguments.jobs)));
  if (arguments.dry_run) {
    SweepContext context;
    context.threads = ThreadsOr(arguments.jobs);
    context.cache_folder = CacheFolder(arguments.common);
    return Announce(plan, WorkAnew(plan, arguments, earlier), context);
  }
  if (arguments.executor == "slurm") return SweepOnSlurm(arguments, plan, file);
  SweepHere(arguments, plan, earlier);
}

}  // namespace depthgrid::cli
