#include "eval/run/joint_runs.h"

#include <deque>

#include "eval/run/ordered_frames.h"
#include "eval/run/synthetic_source.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid {

std::string SharedPart(const ExperimentOptions& options) {
  ExperimentOptions shared = options;
  shared.seed = 0;
  shared.slam_seed = 0;
  shared.depth_seed = options.DepthSeed();
  shared.slam = {};
  shared.mapper = {};
  shared.metrics = {};
  // The true map depends on these (MakeTruth).
  shared.mapper.grid.resolution_m = options.mapper.grid.resolution_m;
  shared.mapper.scan.band_low_m = options.mapper.scan.band_low_m;
  shared.mapper.scan.band_high_m = options.mapper.scan.band_high_m;
  shared.mapper.scan.min_range_m = options.mapper.scan.min_range_m;
  shared.mapper.scan.max_range_m = options.mapper.scan.max_range_m;
  return ToYaml(shared);
}

namespace {

// Makes each image once and gives it to each run's mapper, with that run's poses.
void MapAll(const World& world, const RunContext& context, std::vector<JointRun>& runs) {
  const SyntheticSensor sensor(world, runs.front().options, context.cache_folder);
  std::vector<SlamPlayback> playbacks(runs.size());
  std::deque<FrameRecorder> recorders;
  for (const JointRun& run : runs) {
    recorders.emplace_back(run.options.mapper, sensor.camera(), sensor.FrameCount(),
                           OracleOf(world.trajectory));
  }
  OrderedFrames<std::shared_ptr<const DepthImage>> images(
      sensor.FrameCount(), context.threads,
      [&](int frame) { return std::make_shared<const DepthImage>(sensor.Image(frame)); });
  for (int index = 0; const auto image = images.Next(); ++index) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      Frame frame = playbacks[i].FrameAt(index, runs[i].slam);
      frame.depth = *image;
      recorders[i].Add(frame);
    }
    if (context.progress) context.progress(index + 1, sensor.FrameCount());
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].mapping = recorders[i].Finish(runs[i].slam.final);
  }
}

}  // namespace

JointRuns RunJointly(const std::vector<ExperimentOptions>& given, const RunContext& context) {
  Require(!given.empty(), "there is something to run");
  for (const ExperimentOptions& options : given) {
    Require(SharedPart(options) == SharedPart(given.front()), "joint runs share room and images");
  }
  World world = LoadWorld(given.front(), context.threads);
  std::vector<JointRun> runs;
  for (const ExperimentOptions& options : given) {
    SlamOutput slam = DisturbTrajectory(world.trajectory, options.slam, options.SlamSeed());
    runs.push_back({Completed(options, world.scene), std::move(slam), {}, {}});
  }
  TruthRecord truth = MakeTruth(world, runs.front().options.mapper, context.threads);
  MapAll(world, context, runs);
  for (JointRun& run : runs) run.scores = Score(run.mapping, truth, run.options.metrics);
  return {std::move(world), std::move(truth), std::move(runs)};
}

}  // namespace depthgrid
