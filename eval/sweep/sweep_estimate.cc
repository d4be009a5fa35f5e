#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "eval/sweep/scan_set.h"
#include "eval/sweep/sweep_engine.h"
#include "eval/sweep/sweep_inputs.h"
#include "eval/sweep/sweep_metrics.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/number_rows.h"

namespace depthgrid {
namespace {

// Frames of two test runs, which separate the fixed cost of a run from the cost per frame; together
// they take about a second.
constexpr std::size_t kShortFrames = 24;
constexpr std::size_t kLongFrames = 60;
// Give up when this many points have failed.
constexpr std::size_t kMostTries = 8;
// Kinds of runs (RunKindOf) that are timed; the others take the times of the most similar one.
constexpr std::size_t kMostPilots = 4;

// CPU seconds of parts of a run.
struct PilotTimes {
  double image_s = 0.0;  // per frame, once for all groups that share their images
  double scan_s = 0.0;   // per frame, once for all runs of a group
  double few_s = 0.0;    // mapping and scores of a run of `few_frames`
  double frame_s = 0.0;  // and of each frame beyond these
  double few_frames = 1.0;

  double RunOf(double frames) const {
    return frames < few_frames ? few_s * frames / few_frames
                               : few_s + frame_s * (frames - few_frames);
  }
};

// CPU seconds of a run that ends after `frames` frames.
double RunS(const ScanSet& whole, std::size_t frames, const TruthRecord& truth) {
  ScanSet set = whole;
  set.slam.live.resize(frames);
  set.scans.resize(frames);
  const double before_s = ProcessCpuS();
  ScannedSource source(set);
  const MappingRun mapping = MapExperiment(source, set.options, *set.world, set.slam, {});
  SweepMetrics(Score(mapping, truth, set.options.metrics));
  return ProcessCpuS() - before_s;
}

PilotTimes TimesOfFirstFrames(const ExperimentOptions& options, const SweepContext& context) {
  SweepInputs inputs(context.threads);
  ScanSet set = MakeSet(options, inputs.WorldOf(options));
  const auto truth = inputs.TruthOf(set.options);
  PilotTimes times;
  const std::size_t pilot = std::min(set.slam.live.size(), kLongFrames);
  set.slam.live.resize(pilot);
  set.scans.resize(pilot);
  const SyntheticSensor sensor(*set.world, set.options, context.cache_folder);
  FrameScanner scanner(set.world->camera, set.options.mapper.scan);
  const double before_s = ProcessCpuS();
  for (std::size_t i = 0; i < pilot; ++i) {
    Frame frame;
    const double image_before_s = ProcessCpuS();
    frame.depth = std::make_shared<const DepthImage>(sensor.Image(static_cast<int>(i)));
    times.image_s += (ProcessCpuS() - image_before_s) / static_cast<double>(pilot);
    frame.slam_from_camera = set.slam.live[i].slam_from_camera;
    frame.stamp_s = set.slam.live[i].stamp_s;
    frame.slam_epoch = set.slam.live[i].epoch;
    set.scans[i] = scanner.ScansOf(frame);
  }
  times.scan_s = (ProcessCpuS() - before_s) / static_cast<double>(pilot) - times.image_s;
  const std::size_t few = std::min(pilot, kShortFrames);
  RunS(set, few, *truth);  // warm-up: the first run also pays one-time costs
  times.few_s = RunS(set, few, *truth);
  times.few_frames = static_cast<double>(few);
  if (pilot > few) {
    times.frame_s =
        std::max(0.0, RunS(set, pilot, *truth) - times.few_s) / static_cast<double>(pilot - few);
  }
  return times;
}

// The values that a run's depth images depend on: settings of the mapper and of SLAM do not affect
// them.
std::vector<std::string> ImageKey(const SweepPlan& plan, const PlannedRun& run) {
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
    const std::string& key = plan.parameter_keys[i];
    const bool is_seen = !key.starts_with("mapper.") && !key.starts_with("slam.") &&
                         !key.starts_with("metrics.") && key != "slam_seed";
    if (is_seen) seen.push_back(run.values[i]);
  }
  return seen;
}

// Runs of one kind take about as long for a frame: they have the same value on each axis except
// seeds and frames, where numbers of SLAM and of the fusion count as equal unless one is 0 (which
// may switch something off: a gain of 0 costs a third).
std::vector<std::string> RunKindOf(const SweepPlan& plan, const PlannedRun& run) {
  std::vector<std::string> kind;
  for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
    const std::string& key = plan.parameter_keys[i];
    if (IsSeedKey(key) || key == "frames") continue;
    const auto number = ParseNumber(run.values[i]);
    const bool any =
        number && *number != 0.0 && (key.starts_with("slam.") || key.starts_with("mapper.fusion."));
    kind.push_back(any ? "any" : run.values[i]);
  }
  return kind;
}

std::size_t EqualValues(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::size_t equal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) equal += a[i] == b[i] ? 1 : 0;
  return equal;
}

// Number of frames of each run; its own path's where it does not say.
class FrameCounts {
 public:
  FrameCounts(const SweepPlan& plan, const SweepContext& context)
      : plan_(plan), inputs_(context.threads) {}

  double Of(const PlannedRun& run) {
    const auto [entry, is_new] = known_.emplace(PathKey(run), 0.0);
    if (is_new) entry->second = Count(run);
    return entry->second;
  }

 private:
  // The values that decide how many there are.
  std::vector<std::string> PathKey(const PlannedRun& run) const {
    std::vector<std::string> values;
    for (std::size_t i = 0; i < plan_.parameter_keys.size(); ++i) {
      const std::string& key = plan_.parameter_keys[i];
      if (IsFileKey(key) || key == "frames") values.push_back(run.values[i]);
    }
    return values;
  }
  double Count(const PlannedRun& run) {
    try {
      const ExperimentOptions options = plan_.OptionsOf(run);
      return options.frames > 0 ? options.frames
                                : static_cast<double>(inputs_.WorldOf(options)->trajectory.size());
    } catch (const InputError&) {  // it fails at once
      return 0.0;
    }
  }

  const SweepPlan& plan_;
  SweepInputs inputs_;
  std::map<std::vector<std::string>, double> known_;
};

// Times of some kinds of runs.
struct Pilots {
  std::map<std::vector<std::string>, PilotTimes> times;
  std::string failure;  // of the first run tried that failed

  // Those of the most similar kind.
  const PilotTimes& For(const std::vector<std::string>& kind) const {
    const auto best =
        std::max_element(times.begin(), times.end(), [&](const auto& a, const auto& b) {
          return EqualValues(a.first, kind) < EqualValues(b.first, kind);
        });
    return best->second;
  }
};

// The longest run of each kind. Kinds in the order of their first runs.
std::vector<const PlannedRun*> LongestRuns(const SweepPlan& plan, const std::vector<int>& runs,
                                           FrameCounts& frames) {
  std::vector<const PlannedRun*> longest;
  std::map<std::vector<std::string>, std::size_t> known;
  for (const int run : runs) {
    const PlannedRun& planned = plan.runs[static_cast<std::size_t>(run)];
    const auto [entry, is_new] = known.emplace(RunKindOf(plan, planned), longest.size());
    if (is_new) longest.push_back(&planned);
    const PlannedRun*& best = longest[entry->second];
    if (frames.Of(planned) > frames.Of(*best)) best = &planned;
  }
  return longest;
}

// Of runs that do not fail; others report their failures when they are run.
Pilots PilotsOf(const SweepPlan& plan, const std::vector<const PlannedRun*>& candidates,
                const SweepContext& context) {
  Pilots pilots;
  std::size_t failed = 0;
  for (const PlannedRun* run : candidates) {
    if (pilots.times.size() == kMostPilots || failed == kMostTries) break;
    try {
      NamingPlaces(plan.PlaceOfKey(), [&] {
        const ExperimentOptions options = plan.OptionsOf(*run);
        RequireSound(options, plan.PlaceOfKey());
        pilots.times.emplace(RunKindOf(plan, *run), TimesOfFirstFrames(options, context));
      });
    } catch (const DiskFullError&) {
      throw;
    } catch (const std::exception& error) {
      ++failed;
      if (pilots.failure.empty()) pilots.failure = error.what();
    }
  }
  return pilots;
}

// Evenly spread ones first, so that the timed kinds differ in as much as possible.
std::vector<const PlannedRun*> Spread(const std::vector<const PlannedRun*>& runs) {
  std::vector<const PlannedRun*> spread;
  std::vector<bool> taken(runs.size(), false);
  const auto take = [&](std::size_t i) {
    if (!taken[i]) spread.push_back(runs[i]);
    taken[i] = true;
  };
  for (std::size_t k = 0; k < kMostPilots; ++k) take(k * (runs.size() - 1) / (kMostPilots - 1));
  for (std::size_t i = 0; i < runs.size(); ++i) take(i);
  return spread;
}

}  // namespace

SweepEstimate EstimateSweep(const SweepPlan& plan, const std::vector<int>& runs,
                            const SweepContext& context) {
  SweepEstimate estimate;
  if (runs.empty()) return estimate;
  const std::vector<int> groups = ScanGroups(plan);
  FrameCounts frames(plan, context);
  const Pilots pilots = PilotsOf(plan, Spread(LongestRuns(plan, runs, frames)), context);
  estimate.failure = pilots.failure;
  std::set<int> scans;
  std::set<std::vector<std::string>> images;
  for (const int run : runs) {
    const PlannedRun& planned = plan.runs[static_cast<std::size_t>(run)];
    const bool new_scans = scans.insert(groups[static_cast<std::size_t>(run)]).second;
    const bool new_images = images.insert(ImageKey(plan, planned)).second;
    if (pilots.times.empty()) continue;
    const PilotTimes& times = pilots.For(RunKindOf(plan, planned));
    const double count = frames.Of(planned);
    estimate.cpu_s += times.RunOf(count) + (new_scans ? count * times.scan_s : 0.0) +
                      (new_images ? count * times.image_s : 0.0);
  }
  estimate.scan_sets = static_cast<int>(scans.size());
  return estimate;
}

}  // namespace depthgrid
