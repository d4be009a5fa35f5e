#include "eval/experiment.h"

#include "eval/synthetic_source.h"
#include "sim/slam_surrogate.h"

namespace depthgrid {
RunScores Score(const MappingRun& run, const TruthRecord& truth) {
  RunScores scores;
  scores.slam = ScoreTrajectory(truth.trajectory, SlamTrajectory(run));
  scores.online = ScoreTrajectory(truth.trajectory, OnlineTrajectory(run));
  scores.est = ScoreTrajectory(truth.trajectory, FinalTrajectory(run));
  scores.map = ScoreMap(truth.map, StatesOf(run.result.map), truth.observable);
  return scores;
}

ExperimentOptions Completed(ExperimentOptions options, const Scene& scene) {
  options.mapper.scan.floor_z_m = scene.floor_z_m;
  return options;
}

ExperimentRun RunExperiment(const ExperimentOptions& given, const RunContext& context) {
  World world = LoadWorld(given, context.threads);
  const ExperimentOptions options = Completed(given, world.scene);
  SlamOutput slam = DisturbTrajectory(world.trajectory, options.slam, options.SlamSeed());
  TruthRecord truth = MakeTruth(world, options.mapper, context.threads);
  const SyntheticSensor sensor(world, options, context.cache_folder);
  SyntheticSource source(sensor, slam, context.threads);
  MappingRun mapping = MapFrames(source, options.mapper, slam.final, context.progress);
  RunScores scores = Score(mapping, truth);
  return {options,          std::move(world), std::move(slam), std::move(mapping),
          std::move(truth), std::move(scores)};
}

}  // namespace depthgrid
