#include <algorithm>
#include <optional>
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

namespace depthgrid {
namespace {

// Frames of two test runs, which separate the fixed cost of a run from the cost per frame; together
// they take about a second.
constexpr std::size_t kShortFrames = 24;
constexpr std::size_t kLongFrames = 60;
// Give up when this many points have failed.
constexpr std::size_t kMostTries = 8;

// CPU seconds of parts of a run.
struct PilotTimes {
  std::size_t frames = 0;  // of the whole run
  double image_s = 0.0;    // per frame, once for all groups that share their images
  double scan_s = 0.0;     // per frame, once for all runs of a group
  double run_s = 0.0;      // mapping and scores of all frames
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
  times.frames = set.slam.live.size();
  const std::size_t pilot = std::min(times.frames, kLongFrames);
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
  const double few_s = RunS(set, few, *truth);
  times.run_s = few_s;
  if (pilot > few) {
    const double a_frame_s =
        std::max(0.0, RunS(set, pilot, *truth) - few_s) / static_cast<double>(pilot - few);
    times.run_s += a_frame_s * static_cast<double>(times.frames - few);
  }
  return times;
}

// Number of sets of depth images that the runs use: settings of the mapper and of SLAM do not
// affect them.
int CountImageSets(const SweepPlan& plan, const std::vector<int>& runs) {
  std::set<std::vector<std::string>> sets;
  for (const int run : runs) {
    std::vector<std::string> seen;
    for (std::size_t i = 0; i < plan.parameter_keys.size(); ++i) {
      const std::string& key = plan.parameter_keys[i];
      const bool is_seen = !key.starts_with("mapper.") && !key.starts_with("slam.") &&
                           !key.starts_with("metrics.") && key != "slam_seed";
      if (is_seen) seen.push_back(plan.runs[static_cast<std::size_t>(run)].values[i]);
    }
    sets.insert(std::move(seen));
  }
  return static_cast<int>(sets.size());
}

// Of the first run that does not fail; earlier ones report their failures when they are run.
struct Pilot {
  std::optional<PilotTimes> times;
  std::string failure;  // of the first run tried that failed
};

Pilot PilotOf(const SweepPlan& plan, const std::vector<int>& runs, const SweepContext& context) {
  Pilot pilot;
  std::set<int> tried;  // points
  for (const int run : runs) {
    const PlannedRun& planned = plan.runs[static_cast<std::size_t>(run)];
    if (!tried.insert(planned.point).second) continue;
    if (tried.size() > kMostTries) break;
    try {
      NamingPlaces(plan.PlaceOfKey(), [&] {
        const ExperimentOptions options = plan.OptionsOf(planned);
        RequireSound(options, plan.PlaceOfKey());
        pilot.times = TimesOfFirstFrames(options, context);
      });
      return pilot;
    } catch (const DiskFullError&) {
      throw;
    } catch (const std::exception& error) {
      if (pilot.failure.empty()) pilot.failure = error.what();
    }
  }
  return pilot;
}

}  // namespace

SweepEstimate EstimateSweep(const SweepPlan& plan, const std::vector<int>& runs,
                            const SweepContext& context) {
  SweepEstimate estimate;
  if (runs.empty()) return estimate;
  const std::vector<int> groups = ScanGroups(plan);
  std::set<int> used;
  for (const int run : runs) used.insert(groups[static_cast<std::size_t>(run)]);
  estimate.scan_sets = static_cast<int>(used.size());
  const Pilot pilot = PilotOf(plan, runs, context);
  estimate.failure = pilot.failure;
  if (const auto& times = pilot.times) {
    const auto frames = static_cast<double>(times->frames);
    estimate.cpu_s = CountImageSets(plan, runs) * frames * times->image_s +
                     estimate.scan_sets * frames * times->scan_s +
                     static_cast<double>(runs.size()) * times->run_s;
  }
  return estimate;
}

}  // namespace depthgrid
