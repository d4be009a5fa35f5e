#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "eval/cli/command_output.h"
#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/cli/interrupts.h"
#include "eval/cli/shader_cache.h"
#include "eval/cli/video_output.h"
#include "eval/doubts/experiment_doubts.h"
#include "eval/experiment/idle_settings.h"
#include "eval/experiment/shipped.h"
#include "eval/experiment/study.h"
#include "eval/output/run_folder.h"
#include "eval/run/experiment.h"
#include "eval/study/study_run.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

// If SLAM was lost, the scores cover only the remaining frames.
void PrintLost(const MappingRun& run) {
  const auto lost = std::count_if(run.reports.begin(), run.reports.end(),
                                  [](const auto& report) { return !report.slam_from_camera; });
  if (lost == 0) return;
  const auto poses =
      std::count_if(run.result.map_from_camera.begin(), run.result.map_from_camera.end(),
                    [](const auto& pose) { return pose.has_value(); });
  fmt::print(
      "SLAM was lost in {} of {}, the estimate has a pose for {}: errors are of those only\n\n",
      lost, Counted(run.reports.size(), "frame"), poses);
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

std::optional<double> WallF1(const MapScore& score) {
  const CellScores& cells = score.observable ? *score.observable : score.all;
  return cells.occupied[kDefaultToleranceCells].f1;
}

// Notes overrides: published figures are for the study as its file defines it.
void PrintOverrides(const Study& study) {
  const bool published = std::ranges::any_of(
      study.outline.cases, [](const StudyCase& one) { return one.published_mean_m.has_value(); });
  if (!published || study.overrides.empty()) return;
  fmt::print("published errors are those of the study as it is written, without {}\n",
             Printable(fmt::format("{}", fmt::join(study.overrides, ", "))));
}

void PrintCases(const std::vector<CaseResult>& results) {
  std::vector<std::vector<std::string>> rows = {{"case", "published m", "input mean m",
                                                 "input ATE m", "output mean m", "output ATE m",
                                                 "input map F1", "output map F1"}};
  const auto mean = [](const std::optional<TrajectoryScore>& score) {
    return score ? Number(score->xy_unaligned.mean, 4) : "-";
  };
  const auto aligned = [](const std::optional<TrajectoryScore>& score) {
    return score && score->xy_se2 ? Number(score->xy_se2->rmse, 4) : "-";
  };
  for (const CaseResult& r : results) {
    rows.push_back({r.name, Number(r.published_mean_m, 3), mean(r.scores.slam),
                    aligned(r.scores.slam), mean(r.scores.est), aligned(r.scores.est),
                    Number(WallF1(r.input_map), 3), Number(WallF1(r.scores.map), 3)});
  }
  fmt::print("{}", Table(rows));
}

RunContext ContextOf(const RunArguments& arguments, ProgressBar& bar) {
  RunContext context;
  context.threads = ThreadsOr(arguments.common.threads);
  context.cache_folder = CacheFolder(arguments.common);
  KeepShadersInCache(arguments.common);
  context.progress = bar.AsProgress(kFinishingMap);
  return context;
}

void RunOne(const RunArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const ExperimentOptions options = ExperimentNamed(arguments.experiment, arguments.common.set);
  const std::vector<std::string> inputs = InputsOf(arguments.experiment, {options});
  RequireVideoFile(arguments.output, arguments.common, inputs);
  OutputFolder folder = OpenOutput(arguments.common, ResultKind::kRun, inputs);
  ProgressBar bar("mapping");
  const ExperimentRun run = RunExperiment(options, ContextOf(arguments, bar));
  RunRecord record = RecordOf(run.options, run.world, run.slam, run.mapping, run.truth, run.scores);
  for (const std::vector<std::string>& doubts :
       {DoubtsOfSettings(arguments.experiment, arguments.common.set),
        DoubtsOfExperiment(run.world, run.mapping, run.truth, run.options)}) {
    record.warnings.insert(record.warnings.end(), doubts.begin(), doubts.end());
  }
  record.map_mode = arguments.output.map_mode;
  record.wall_s_total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_s_total = ProcessCpuS();
  bar.Say("writing the folder and the report");
  WriteRunFolder(folder, record);
  folder.Commit();
  NoteResult("the run is in " + arguments.common.output);
  if (const auto no_colour = AddColour(arguments.common.output, record)) {
    record.warnings.push_back(*no_colour);
  }
  WriteVideo(arguments.output, arguments.common, run.mapping, run.options.mapper.grid);
  bar.Clear();
  Warn(record.warnings);
  PrintScores(run.scores);
  PrintLost(run.mapping);
  SayReport(arguments.common.output);
}

void RunCases(const RunArguments& arguments, const std::string& path) {
  if (!arguments.output.video.empty()) {
    throw InputError("--video " + arguments.output.video, "shows one run; run a case by itself");
  }
  Config overrides;
  for (const std::string& assignment : arguments.common.set) overrides.Set(assignment);
  const std::string base_folder = fs::path(path).parent_path().string();
  Study study = ReadStudy(Config::FromFile(path), overrides, base_folder);
  study.overrides = arguments.common.set;
  std::vector<std::string> warnings = study.warnings;
  const auto idle = DoubtsOfOverrides(
      arguments.common.set, IdleInEveryCase(study), [&](const std::vector<std::string>& set) {
        Config some;
        for (const std::string& assignment : set) some.Set(assignment);
        return ToYaml(ReadStudy(Config::FromFile(path), some, base_folder).experiments.front());
      });
  warnings.insert(warnings.end(), idle.begin(), idle.end());
  std::vector<std::string> cases;
  for (const StudyCase& one : study.outline.cases) cases.push_back(one.name);
  OutputFolder folder =
      OpenOutput(arguments.common, ResultKind::kStudy, InputsOf(path, study.experiments), cases);
  ProgressBar bar("mapping");
  const auto results =
      RunStudy(study, ReadFile(path), arguments.output.map_mode, folder, ContextOf(arguments, bar));
  folder.Commit();
  bar.Clear();
  for (const CaseResult& result : results) {
    for (const std::string& warning : result.warnings) {
      warnings.push_back("case " + result.name + ": " + warning);
    }
  }
  Warn(warnings);
  PrintCases(results);
  PrintOverrides(study);
  SayReport(arguments.common.output);
}

}  // namespace

void Run(const RunArguments& arguments) {
  const std::string path = ResolveName(arguments.experiment, ShippedKind::kExperiment);
  if (IsStudy(ExperimentFile(path))) {
    RunCases(arguments, path);
  } else {
    NamingPlaces(PlacesOf(arguments.experiment, arguments.common.set), [&] { RunOne(arguments); });
  }
}

std::string ExperimentKeys() { return ListKeys(ExperimentOptions{}); }

}  // namespace depthgrid::cli
