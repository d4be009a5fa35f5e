#include <fmt/format.h>

#include <cstdio>
#include <numeric>

#include "eval/cli/command_output.h"
#include "eval/cli/commands.h"
#include "eval/cli/console.h"
#include "eval/cli/experiment_argument.h"
#include "eval/experiment/seed_range.h"
#include "eval/experiment/shipped.h"
#include "eval/study/ablation.h"
#include "eval/study/ablation_report.h"
#include "eval/sweep/sweep_cache.h"
#include "mapper/core/error.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"

namespace depthgrid::cli {
namespace {

void PrintShares(const ErrorShares& score) {
  const std::string unit = score.metric.ends_with("_m") ? " m" : "";
  fmt::print("\n{}{}: {}{} as it is\n", score.is_complement ? "1 - " : "", score.metric,
             Short(score.error), unit);
  std::vector<std::vector<std::string>> rows = {{"truth for", "error" + unit, "owned" + unit,
                                                 "95 % interval" + unit, "share", "p", "p Holm"}};
  for (const StageShare& stage : score.stages) {
    const auto& interval = stage.gain.mean_interval;
    rows.push_back(
        {stage.variant, Short(stage.error), Short(0.0 - stage.gain.mean_difference),
         interval ? fmt::format("[{}, {}]", Short(-interval->high), Short(-interval->low)) : "-",
         stage.share ? Number(100.0 * *stage.share, 0) + " %" : "-",
         fmt::format("{:.3g}", stage.gain.wilcoxon.p_value), fmt::format("{:.3g}", stage.p_holm)});
  }
  fmt::print("{}", Table(rows));
}

void PrintLegend(std::size_t seeds) {
  fmt::print("{}; owned: how much the error falls when the truth is put in, paired by seed\n",
             Counted(seeds, "seed"));
  constexpr int kNameWidth = 10;
  for (const AblationVariant& variant : AblationVariants()) {
    if (variant.against.empty()) continue;
    fmt::print("  {:<{}}  {} (against {})\n", variant.name, kNameWidth, variant.meaning,
               variant.against);
  }
}

void WarnOfRepeatedSeeds(std::size_t counted, std::size_t seeds) {
  if (counted == seeds) return;
  Warn({fmt::format(
      "{} of {} give the same scores as another and do not count: nothing here depends on the seed",
      seeds - counted, Counted(seeds, "seed"))});
}

AblationPlan PlanOf(const AblateArguments& arguments) {
  RequireNotSet(arguments.common.set, "seed", "give --first-seed N");
  AblationPlan plan;
  plan.experiment = ExperimentNamed(arguments.experiment, arguments.common.set);
  RequireSeeds("--first-seed", arguments.first_seed, arguments.seeds);
  plan.seeds.resize(static_cast<std::size_t>(arguments.seeds));
  std::iota(plan.seeds.begin(), plan.seeds.end(), arguments.first_seed);
  return plan;
}

void Announce(const std::string& experiment, const AblationPlan& plan) {
  const std::size_t variants = AblationVariants().size();
  fmt::print("{}: {}, {} variants x {}\n", experiment, Counted(variants * plan.seeds.size(), "run"),
             variants, Counted(plan.seeds.size(), "seed"));
  std::fflush(stdout);
}

void AblateNamed(const AblateArguments& arguments) {
  const AblationPlan plan = PlanOf(arguments);
  Warn(DoubtsOfSettings(arguments.experiment, arguments.common.set));
  OutputFolder folder = OpenOutput(arguments.common, ResultKind::kAblation,
                                   InputsOf(arguments.experiment, {plan.experiment}));
  ProgressBar bar("ablating");
  RunContext context;
  context.threads = ThreadsOr(arguments.common.threads);
  context.cache_folder = CacheFolder(arguments.common);
  // By default as a sweep's, in its folder: the variants of all seeds see the same room.
  const bool own_cache = context.cache_folder.empty() && !arguments.common.no_cache;
  if (own_cache) context.cache_folder = folder.File("cache");
  // Announced once the first run is on its way, so that refused input is all that is said of it.
  bool is_announced = arguments.json;
  context.progress = [&, show = bar.AsProgress()](int done, int total) {
    if (!is_announced) Announce(arguments.experiment, plan);
    is_announced = true;
    show(done, total);
  };
  const auto [runs, warnings] = RunAblation(plan, context);
  if (own_cache) RemoveSweepCache(context.cache_folder);
  const std::vector<AblationRun> counted = WithoutRepeatedSeeds(runs);
  const std::size_t seeds = counted.size() / AblationVariants().size();
  const std::vector<ErrorShares> shares = SharesOf(counted);
  const std::string json = AblationJson(shares, seeds, LoadNamedScene(plan.experiment.scene).name);
  WriteFile(folder.File("experiment.yaml"), ToYaml(plan.experiment));
  WriteFile(folder.File("ablation.csv"), AblationCsv(runs));
  WriteFile(folder.File("ablation.json"), json);
  WriteAblationReport(folder.work().string(), {folder.work().string()});
  folder.Commit();
  bar.Clear();
  Warn(warnings);
  WarnOfRepeatedSeeds(seeds, plan.seeds.size());
  if (arguments.json) {
    fmt::print("{}", json);
    return;
  }
  PrintLegend(seeds);
  for (const ErrorShares& score : shares) PrintShares(score);
  SayReport(arguments.common.output);
}

}  // namespace

void Ablate(const AblateArguments& arguments) {
  NamingPlaces(PlacesOf(arguments.experiment, arguments.common.set),
               [&] { AblateNamed(arguments); });
}

}  // namespace depthgrid::cli
