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

ExperimentRun RunExperiment(const ExperimentOptions& options, const RunContext& context) {
  World world = LoadWorld(options, context.threads);
  SlamOutput slam = DisturbTrajectory(world.trajectory, options.slam, options.SlamSeed());
  const SyntheticSensor sensor(world, options);
  SyntheticSource source(sensor, slam, context.threads);
  MappingRun mapping = MapFrames(source, options.mapper, slam.final, context.progress);
  TruthRecord truth;
  truth.trajectory = world.trajectory;
  RunScores scores = Score(mapping, truth);
  return {std::move(world), std::move(slam),   std::move(mapping),
          std::move(truth), std::move(scores), 0.0};
}

}  // namespace depthgrid
