#include "eval/study/ablation.h"

#include <cmath>

#include "eval/doubts/truth_check.h"
#include "eval/doubts/view_check.h"
#include "eval/files/metric_columns.h"
#include "eval/output/run_folder.h"
#include "eval/run/synthetic_source.h"
#include "mapper/core/level.h"
#include "sim/slam/slam_surrogate.h"
#include "sim/truth/true_scan.h"

namespace depthgrid {
namespace {

// Scans cast in the true room, with SLAM's output.
class TrueScanSource final : public FrameSource {
 public:
  TrueScanSource(const World& world, const MapperOptions& mapper, SlamOutput slam)
      : camera_(world.camera),
        floor_z_m_(world.scene.floor_z_m),
        scanner_(world.scene.mesh, world.scene.floor_z_m, world.rays, world.camera,
                 {mapper.scan.beams, mapper.scan.band_low_m, mapper.scan.band_high_m,
                  mapper.scan.min_range_m, mapper.scan.max_range_m, world.depth_range.min_m,
                  world.depth_range.max_m, mapper.grid.resolution_m}),
        trajectory_(world.trajectory),
        slam_(std::move(slam)) {}

  std::optional<Frame> Next() override {
    if (next_ >= FrameCount()) return std::nullopt;
    const Pose3& world_from_camera = trajectory_[static_cast<std::size_t>(next_)].world_from_camera;
    Frame frame = playback_.FrameAt(next_++, slam_);
    frame.scan = std::make_shared<const Scan>(scanner_.Obstacles(world_from_camera));
    frame.matched_scan = std::make_shared<const Scan>(scanner_.Slice(world_from_camera));
    frame.stand = StandOf(world_from_camera, floor_z_m_);
    return frame;
  }
  std::optional<PinholeCamera> Camera() const override { return camera_; }
  int FrameCount() const override { return static_cast<int>(trajectory_.size()); }
  std::vector<std::string> Warnings() const override { return {}; }

 private:
  PinholeCamera camera_;
  double floor_z_m_;
  TrueScanner scanner_;
  Trajectory trajectory_;
  SlamOutput slam_;
  int next_ = 0;
  SlamPlayback playback_;
};

SlamOptions WithTruth(SlamOptions slam, const TrueStages& truth) {
  if (truth.poses) {
    const SlamLoopOptions loops = slam.loops;
    slam = ProfileOptions(SlamProfile::kGroundTruth);
    slam.loops = loops;
  }
  if (truth.loops) {
    // Not zero, because the mapper weights loops by these.
    constexpr double kNearlyExactM = 1e-3;
    constexpr double kNearlyExactDeg = 0.05;
    slam.loops = WithScenario(slam.loops, LoopScenario::kTrue);
    slam.loops.sigma_translation_m = kNearlyExactM;
    slam.loops.sigma_rotation_deg = kNearlyExactDeg;
  }
  return slam;
}

ExperimentOptions WithTruth(ExperimentOptions options, const TrueStages& truth) {
  options.slam = WithTruth(options.slam, truth);
  if (truth.depth) {
    const SensorOptions exact;
    // Removes the noise model but keeps the sensor's range limits, which are not noise.
    const DepthRange range = SensorRange(options.sensor);
    options.sensor.min_range_m = range.min_m;
    if (std::isfinite(range.max_m)) options.sensor.max_range_m = range.max_m;
    options.sensor.noise = DepthNoiseModel::kNone;
    options.sensor.grazing_limit_deg = exact.grazing_limit_deg;
    options.sensor.flying_pixels = 0.0;
    options.sensor.shadow_baseline_m = 0.0;
  }
  return options;
}

// The data that do not depend on the seed.
struct Stage {
  const World& world;
  const TruthRecord& truth;
  const RunContext& context;
};

MappingRun RunOne(const Stage& stage, const ExperimentOptions& given, const TrueStages& truth) {
  const ExperimentOptions options = WithTruth(given, truth);
  const Trajectory& path = stage.world.trajectory;
  const SlamOutput slam = DisturbTrajectory(path, options.slam, options.SlamSeed());
  MatchOracle match;
  if (truth.matcher) {
    match = [&path](int frame) {
      return BaseOf(path[static_cast<std::size_t>(frame)].world_from_camera);
    };
  }
  std::optional<SyntheticSensor> sensor;
  std::unique_ptr<FrameSource> source;
  if (truth.converter) {
    source = std::make_unique<TrueScanSource>(stage.world, options.mapper, slam);
  } else {
    sensor.emplace(stage.world, options, stage.context.cache_folder);
    source = std::make_unique<SyntheticSource>(*sensor, slam, stage.context.threads);
  }
  return MapFrames(*source, options.mapper,
                   {.final_poses = slam.final,
                    .progress = stage.context.progress,
                    .oracle = OracleOf(path),
                    .match_oracle = match});
}

std::vector<std::pair<std::string, double>> ColumnsOf(const RunScores& scores) {
  return MetricColumns(MetricsOf(scores), "metrics.json");
}

// Counts the frames of all runs as one.
RunContext Counting(const RunContext& context, int runs, int frames, int& finished) {
  RunContext counting = context;
  if (context.progress) {
    counting.progress = [&context, runs, frames, &finished](int done, int) {
      context.progress(finished * frames + done, runs * frames);
    };
  }
  return counting;
}

}  // namespace

const std::vector<AblationVariant>& AblationVariants() {
  static const std::vector<AblationVariant> kVariants = {
      {"as_it_is", {}, "", "the experiment"},
      {"poses", {.poses = true}, "as_it_is", "SLAM's poses are true"},
      {"depth", {.depth = true}, "as_it_is", "depth images are exact"},
      {"converter", {.converter = true}, "depth", "scans are cast in the room"},
      {"matcher", {.matcher = true}, "as_it_is", "matched poses are true"},
      {"loops", {.loops = true}, "as_it_is", "SLAM closes every revisit at once, exactly"},
      {"all", {true, true, true, true, true}, "as_it_is", "all of these"},
  };
  return kVariants;
}

AblationResult RunAblation(const AblationPlan& plan, const RunContext& context) {
  const World world = LoadWorld(plan.experiment, context.threads);
  ExperimentOptions options = Completed(plan.experiment, world.scene);
  const TruthRecord truth = MakeTruth(world, options.mapper, context.threads);
  const auto& variants = AblationVariants();
  int finished = 0;
  const RunContext counting =
      Counting(context, static_cast<int>(variants.size() * plan.seeds.size()),
               static_cast<int>(world.trajectory.size()), finished);
  AblationResult result;
  result.warnings = world.path_doubts;
  if (auto doubt = DoubtOfTruth(world, truth, options)) result.warnings.push_back(*doubt);
  for (const std::uint64_t seed : plan.seeds) {
    options.seed = seed;
    for (const AblationVariant& variant : variants) {
      const MappingRun run = RunOne({world, truth, counting}, options, variant.truth);
      // Checked for the unchanged experiment, which is the first run.
      const auto doubt = finished == 0 ? DoubtOfView(run, options) : std::nullopt;
      if (doubt) result.warnings.push_back(*doubt);
      const RunScores scores = Score(run, truth, options.metrics);
      result.runs.push_back({variant.name, seed, ColumnsOf(scores)});
      ++finished;
    }
  }
  return result;
}

}  // namespace depthgrid
