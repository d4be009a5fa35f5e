#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/experiment.h"
#include "eval/output_folder.h"
#include "eval/run_folder.h"
#include "mapper/io/config.h"

namespace depthgrid::cli {
namespace {

double ProcessCpuS() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string Number(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

void PrintScores(const RunScores& scores) {
  const auto row = [](const char* name, const std::optional<TrajectoryScore>& score) {
    if (!score) return std::vector<std::string>{name, "-", "-", "-"};
    const auto se2 = score->xy_se2 ? std::optional(score->xy_se2->rmse) : std::nullopt;
    return std::vector<std::string>{name, Number(score->xy_unaligned.mean, 4), Number(se2, 4),
                                    Number(score->xyz_unaligned.mean, 4)};
  };
  fmt::print("{}", Table({{"trajectory", "mean xy m", "ATE rmse SE(2) m", "mean xyz m"},
                          row("slam", scores.slam),
                          row("online", scores.online),
                          row("estimate", scores.est)}));
  std::vector<std::vector<std::string>> maps = {
      {"map, 1-cell tolerance", "precision", "recall", "F1", "free F1", "chamfer m", "coverage"}};
  const auto add = [&](const char* name, const CellScores& cells) {
    const StateScore& walls = cells.occupied[kDefaultToleranceCells];
    maps.push_back({name, Number(walls.precision, 3), Number(walls.recall, 3), Number(walls.f1, 3),
                    Number(cells.free[kDefaultToleranceCells].f1, 3), Number(cells.chamfer_m, 4),
                    Number(cells.coverage, 3)});
  };
  if (scores.map.observable) add("observable cells", *scores.map.observable);
  add("all cells", scores.map.all);
  fmt::print("\n{}\n", Table(maps));
}

}  // namespace

void Run(const RunArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const ExperimentOptions options = ExperimentNamed(arguments.experiment, arguments.common.set);
  OutputFolder folder(arguments.common.output, arguments.common.force);
  RunContext context;
  context.threads = ThreadsOr(arguments.common.threads);
  context.cache_folder = CacheFolder(arguments.common);
  ProgressBar bar("mapping");
  context.progress = bar.AsProgress();
  const ExperimentRun run = RunExperiment(options, context);
  RunRecord record;
  record.title = arguments.experiment;
  record.settings = ToYaml(run.options);
  record.scene_hash = run.world.scene_hash;
  record.mapping = &run.mapping;
  record.slam = &run.slam;
  record.truth = &run.truth;
  record.scores = &run.scores;
  record.scene = &run.world.scene;
  record.scan = run.options.mapper.scan;
  record.wall_s_total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_s_total = ProcessCpuS();
  bar.Say("writing the folder and the report");
  WriteRunFolder(folder, record);
  folder.Commit();
  bar.Clear();
  Warn(run.mapping.warnings);
  PrintScores(run.scores);
  SayReport(arguments.common.output);
}

std::string ExperimentKeys() { return ListKeys(ExperimentOptions{}); }

}  // namespace depthgrid::cli
