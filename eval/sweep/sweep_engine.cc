#include "eval/sweep/sweep_engine.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <map>
#include <mutex>

#include "eval/metrics/statistics.h"
#include "eval/statistics/resamples.h"
#include "eval/statistics/seed_units.h"
#include "eval/sweep/parallel.h"
#include "eval/sweep/scan_maker.h"
#include "eval/sweep/sweep_doubts.h"
#include "eval/sweep/sweep_inputs.h"
#include "eval/sweep/sweep_metrics.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Scans of a batch of groups are held in memory up to this size: enough that threads seldom wait
// for each other at the end of a batch (20 sets of 900 frames), and little for a laptop.
constexpr std::size_t kBatchBytes = std::size_t{512} << 20U;
// A batch also ends after this many groups if the next one uses other images: runs are recorded
// only once a batch has its scans, and a kill loses the rest.
constexpr std::size_t kBatchGroups = 16;

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Runs that share their scans.
struct Group {
  std::vector<const PlannedRun*> runs;
  ScanSet scans;
};

NamedValues TimesOf(const MappingRun& run, double cpu_s, double wall_s) {
  constexpr double kP95 = 0.95;
  const std::vector<double> frames_us = TimesOfMappedFrames(run);
  NamedValues times = {{"time_cpu_s", cpu_s}, {"time_wall_s", wall_s}};
  if (!frames_us.empty()) {
    times.emplace_back("cpu_us_per_frame_median", Percentile(frames_us, 0.5));
    times.emplace_back("cpu_us_per_frame_p95", Percentile(frames_us, kP95));
  }
  return times;
}

class Engine {
 public:
  Engine(const SweepPlan& plan, SweepDatabase& database, const SweepContext& context)
      : plan_(plan), database_(database), context_(context), inputs_(context.threads) {}

  // Does a batch of groups at a time, with groups that use the same images next to each other.
  void Do(const std::vector<const PlannedRun*>& runs, const std::vector<int>& group_of_run) {
    std::map<int, Group> groups;
    for (const PlannedRun* run : runs) {
      groups[group_of_run[static_cast<std::size_t>(run->run)]].runs.push_back(run);
    }
    std::vector<Group*> batch;
    std::size_t bytes = 0;
    const auto finish_batch = [&] {
      DoBatch(batch);
      for (Group* done : batch) *done = {};
      batch.clear();
      bytes = 0;
    };
    for (const std::vector<Group*>& alike : ByImages(groups)) {
      for (Group* group : alike) {
        Prepare(*group);
        bytes += BytesOf(group->scans);
        batch.push_back(group);
        if (bytes >= kBatchBytes) finish_batch();
      }
      if (batch.size() >= kBatchGroups) finish_batch();
    }
    finish_batch();
  }

  void SetProgress(int done, int total) {
    done_ = done;
    total_ = total;
    Tick();
  }
  int done() const { return done_; }
  std::vector<std::string> doubts() const { return doubts_.Lines(plan_); }

 private:
  void Tick() {
    if (context_.progress) context_.progress(done_, total_);
  }

  // Remembers a stop, because a stopped run has not failed.
  void TickInRun() {
    const std::lock_guard lock(mutex_);
    try {
      Tick();
    } catch (...) {
      stopped_ = true;
      throw;
    }
  }

  // Makes the set without its scans; an error is the failure of each of its runs.
  void Prepare(Group& group) {
    try {
      NamingPlaces(plan_.PlaceOfKey(), [&] {
        const ExperimentOptions options = plan_.OptionsOf(*group.runs.front());
        group.scans = MakeSet(options, inputs_.WorldOf(options));
      });
    } catch (const std::exception& error) {
      group.scans.failure = error.what();
    }
    Tick();
  }

  // Collects groups that use the same images, in order of their first group. The sets are released
  // meanwhile, because there may be thousands.
  std::vector<std::vector<Group*>> ByImages(std::map<int, Group>& groups) {
    std::map<std::string, std::size_t> position;
    std::vector<std::vector<Group*>> alike;
    for (auto& [number, group] : groups) {
      Prepare(group);
      const std::string key = group.scans.failure.empty() ? DepthKey(group.scans) : "";
      if (position.try_emplace(key, alike.size()).second) alike.emplace_back();
      alike[position[key]].push_back(&group);
      group.scans = {};
    }
    return alike;
  }

  void DoBatch(const std::vector<Group*>& batch) {
    std::vector<ScanSet*> sets;
    std::vector<std::pair<const PlannedRun*, const ScanSet*>> runs;
    for (Group* group : batch) {
      sets.push_back(&group->scans);
      for (const PlannedRun* run : group->runs) runs.emplace_back(run, &group->scans);
    }
    MakeScans(sets, {context_.threads, context_.cache_folder, [this] { Tick(); }});
    ForEachIndex(runs.size(), context_.threads, [&](std::size_t i) {
      const RunOutcome outcome = OutcomeOf(*runs[i].first, *runs[i].second);
      const std::lock_guard lock(mutex_);
      database_.Record(outcome);
      ++done_;
      Tick();
    });
  }

  RunOutcome OutcomeOf(const PlannedRun& run, const ScanSet& scans) {
    const Clock::time_point start = Clock::now();
    const double cpu_before_s = ThreadCpuS();
    RunOutcome outcome;
    outcome.run = run.run;
    MappingRun mapping;
    try {
      NamingPlaces(plan_.PlaceOfKey(), [&] {
        ExperimentOptions options = plan_.OptionsOf(run);
        // Its message is more helpful than a later failure.
        RequireSound(options, plan_.PlaceOfKey());
        if (!scans.failure.empty()) throw InputError("", scans.failure);
        options = Completed(options, scans.world->scene);
        const auto truth = inputs_.TruthOf(options);
        ScannedSource source(scans);
        mapping = MapExperiment(source, options, *scans.world, scans.slam,
                                [this](int, int) { TickInRun(); });
        outcome.metrics = SweepMetrics(Score(mapping, *truth, options.metrics));
        const std::lock_guard lock(mutex_);
        doubts_.Add(run, mapping.result.map, *truth, options);
      });
    } catch (const std::exception& error) {
      if (stopped_) throw;
      outcome.failure = error.what();
    }
    outcome.times = TimesOf(mapping, ThreadCpuS() - cpu_before_s, SecondsSince(start));
    return outcome;
  }

  const SweepPlan& plan_;
  SweepDatabase& database_;
  const SweepContext& context_;
  SweepInputs inputs_;
  std::mutex mutex_;
  RunDoubts doubts_;
  std::atomic<bool> stopped_ = false;
  int done_ = 0;
  int total_ = 0;
};

std::vector<const PlannedRun*> Unfinished(const SweepPlan& plan, const SweepDatabase& database) {
  std::vector<const PlannedRun*> runs;
  for (const int run : database.UnfinishedRuns()) {
    runs.push_back(&plan.runs[static_cast<std::size_t>(run)]);
  }
  return runs;
}

// The units of a point's runs, in the order of its runs.
SeedUnits SeedUnitsOf(const SweepPlan& plan, std::size_t runs_of_point) {
  std::vector<std::vector<std::string>> seeds(runs_of_point);
  for (std::size_t k = 0; k < plan.parameter_keys.size(); ++k) {
    if (!IsSeedKey(plan.parameter_keys[k])) continue;
    for (std::size_t i = 0; i < runs_of_point; ++i) seeds[i].push_back(plan.runs[i].values[k]);
  }
  return SeedUnits(seeds);
}

// Whether the mean over a point's first runs is accurate enough. Failed runs do not count. Runs
// with crossed seeds count as the number of units seen so far (SeedUnits).
bool IsSure(const StopOptions& stop, const SeedUnits& units, std::size_t runs_of_point,
            std::vector<double> values) {
  if (units.count() < runs_of_point) {
    values.resize(runs_of_point, std::numeric_limits<double>::quiet_NaN());
    values = units.Figures(values);
  }
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (static_cast<int>(values.size()) < stop.min_seeds) return false;
  const auto interval = MeanInterval(values, Resamples(values.size()));
  return interval && interval->high - interval->low < stop.width;
}

// For sweeps whose points may stop early: all points are run with one seed after the other, and
// after each seed the remaining runs of points that are accurate enough are dropped. The decision
// depends only on the seeds so far, so it is the same whatever the threads, interruptions and
// machines.
void DoRunsBySeed(const SweepPlan& plan, SweepDatabase& database, Engine& engine,
                  const std::vector<int>& groups) {
  const auto seeds = static_cast<int>(plan.runs.size()) / plan.point_count;
  const SeedUnits units = SeedUnitsOf(plan, static_cast<std::size_t>(seeds));
  const std::vector<int> planned = database.PlannedRuns();
  std::map<int, std::vector<int>> seeds_of_point;  // the runs of each, in order
  for (const int run : planned) seeds_of_point[run / seeds].push_back(run);
  for (int seed = 0; seed < seeds; ++seed) {
    std::vector<const PlannedRun*> runs;
    for (const PlannedRun* run : Unfinished(plan, database)) {
      if (run->run % seeds == seed) runs.push_back(run);
    }
    engine.Do(runs, groups);
    std::vector<int> dropped;
    for (auto& [point, all] : seeds_of_point) {
      const auto count = static_cast<std::size_t>(seed) + 1;
      if (all.size() <= count) continue;
      const std::vector<int> so_far(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
      const std::vector<double> values = database.MetricOf(plan.stop.metric, so_far);
      if (!IsSure(plan.stop, units, static_cast<std::size_t>(seeds), values)) continue;
      dropped.insert(dropped.end(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
      all.resize(count);
    }
    database.Drop(dropped);
    const auto total = static_cast<int>(database.PlannedRuns().size());
    engine.SetProgress(engine.done(), total);
  }
}

}  // namespace

std::vector<std::string> DoRuns(const SweepPlan& plan, SweepDatabase& database,
                                const SweepContext& context) {
  Engine engine(plan, database, context);
  const std::vector<const PlannedRun*> runs = Unfinished(plan, database);
  const auto planned = static_cast<int>(database.PlannedRuns().size());
  engine.SetProgress(planned - static_cast<int>(runs.size()), planned);
  const std::vector<int> groups = ScanGroups(plan);
  if (plan.stop.Enabled()) {
    DoRunsBySeed(plan, database, engine, groups);
  } else {
    engine.Do(runs, groups);
  }
  return engine.doubts();
}

}  // namespace depthgrid
