#include "eval/run/experiment.h"

#include "eval/run/slam_noise.h"
#include "eval/run/synthetic_source.h"
#include "mapper/core/level.h"
#include "mapper/fuse/fusion.h"
#include "sim/slam/slam_surrogate.h"

namespace depthgrid {

RunScores Score(const MappingRun& run, const TruthRecord& truth, const MetricsOptions& options) {
  RunScores scores;
  scores.slam = ScoreTrajectory(truth.trajectory, SlamTrajectory(run));
  scores.online = ScoreTrajectory(truth.trajectory, OnlineTrajectory(run));
  scores.est = ScoreTrajectory(truth.trajectory, FinalTrajectory(run));
  scores.map = ScoreMap(truth.map, StatesOf(run.result.map), truth.observable);
  scores.map.quality = ScoreMapQuality(truth.map, run.result.map, truth.observable, options);
  scores.consistency = ScoreConsistency(run.reports, truth.trajectory);
  return scores;
}

ExperimentOptions Completed(ExperimentOptions options, const Scene& scene) {
  options.mapper.scan.floor_z_m = scene.floor_z_m;
  SlamNoiseOptions& noise = options.mapper.fusion.slam_noise;
  if (noise.source == SlamNoiseSource::kProfile) noise = NoiseOf(options.slam);
  return options;
}

GainOracle OracleOf(const Trajectory& truth) {
  return [&truth](int frame, const Pose2& predicted, const Pose2& matched) {
    const Pose3& true_pose = truth[static_cast<std::size_t>(frame)].world_from_camera;
    return OracleGain(BaseOf(true_pose), predicted, matched);
  };
}

MappingRun MapExperiment(FrameSource& source, const ExperimentOptions& completed,
                         const World& world, const SlamOutput& slam, const Progress& progress) {
  return MapFrames(
      source, completed.mapper,
      {.final_poses = slam.final, .progress = progress, .oracle = OracleOf(world.trajectory)});
}

ExperimentRun RunExperiment(const ExperimentOptions& given, const RunContext& context) {
  World world = LoadWorld(given, context.threads);
  const ExperimentOptions options = Completed(given, world.scene);
  SlamOutput slam = DisturbTrajectory(world.trajectory, options.slam, options.SlamSeed());
  TruthRecord truth = MakeTruth(world, options.mapper, context.threads);
  const SyntheticSensor sensor(world, options, context.cache_folder);
  SyntheticSource source(sensor, slam, context.threads);
  MappingRun mapping = MapExperiment(source, options, world, slam, context.progress);
  RunScores scores = Score(mapping, truth, options.metrics);
  return {options,          std::move(world), std::move(slam), std::move(mapping),
          std::move(truth), std::move(scores)};
}

}  // namespace depthgrid
