#include <fmt/format.h>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/metrics/trajectory_metrics.h"
#include "eval/metrics_json.h"
#include "mapper/core/error.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid::cli {
namespace {

using Row = std::vector<std::string>;

Row StatisticsRow(const std::string& name, const std::optional<Statistics>& s) {
  if (!s) return {name, "-", "-", "-", "-", "-", "-"};
  const auto text = [](double value) { return fmt::format("{:.6f}", value); };
  return {name,         text(s->rmse), text(s->mean), text(s->median),
          text(s->std), text(s->min),  text(s->max)};
}

void PrintTable(const TrajectoryScore& score) {
  fmt::print("{} of {} reference and {} estimated poses matched, {:.3f} m of path\n\n",
             score.matched_poses, score.reference_poses, score.estimate_poses,
             score.reference_path_m);
  fmt::print("{}", Table({{"error", "rmse", "mean", "median", "std", "min", "max"},
                          StatisticsRow("xy, not aligned (m)", score.xy_unaligned),
                          StatisticsRow("xy, first pose aligned (m)", score.xy_origin),
                          StatisticsRow("xy, SE(2) aligned (m)", score.xy_se2),
                          StatisticsRow("xyz, not aligned (m)", score.xyz_unaligned),
                          StatisticsRow("xyz, first pose aligned (m)", score.xyz_origin),
                          StatisticsRow("xyz, SE(3) aligned (m)", score.xyz_se3),
                          StatisticsRow("xyz, Sim(3) aligned (m)", score.xyz_sim3),
                          StatisticsRow("rotation, not aligned (rad)", score.rotation_unaligned),
                          StatisticsRow("rotation, SE(3) aligned (rad)", score.rotation_se3),
                          StatisticsRow("relative, 1 pose (m)", score.rpe_frame_translation),
                          StatisticsRow("relative, 1 pose (rad)", score.rpe_frame_rotation),
                          StatisticsRow("relative, 1 m (m)", score.rpe_metre_translation),
                          StatisticsRow("relative, 1 m (rad)", score.rpe_metre_rotation)}));
}

}  // namespace

void EvalTrajectory(const EvalTrajectoryArguments& arguments) {
  const Trajectory reference = ReadTrajectory(arguments.reference);
  const Trajectory estimate = ReadTrajectory(arguments.estimate);
  const auto score = ScoreTrajectory(reference, estimate, arguments.max_difference_s);
  if (!score) {
    throw InputError(arguments.estimate,
                     fmt::format("shares no stamp with {} (within {} s)", arguments.reference,
                                 arguments.max_difference_s));
  }
  if (arguments.json) {
    fmt::print("{}", MetricsJson({{"est", score}}, nullptr));
  } else {
    PrintTable(*score);
  }
}

}  // namespace depthgrid::cli
