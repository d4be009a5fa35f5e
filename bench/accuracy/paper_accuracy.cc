// The cases of a study over many seeds, mapped in several ways: the tables of docs/results.md, "The
// paper's experiment". Results, not times.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "eval/input_map.h"
#include "eval/joint_runs.h"
#include "eval/metrics/statistics.h"
#include "eval/shipped.h"
#include "eval/study.h"

using namespace depthgrid;

namespace {

// A way of mapping: a name and the keys that make it, "name key=value key=value".
struct Variant {
  std::string name;
  Config keys;
};

Variant ParseVariant(const std::string& text) {
  std::istringstream words(text);
  Variant variant;
  words >> variant.name;
  for (std::string assignment; words >> assignment;) variant.keys.Set(assignment);
  return variant;
}

struct Row {
  double input_m = 0, input_f1 = 0;  // SLAM's live poses and the map they make
  double online_m = 0, output_m = 0, output_ate_m = 0, f1 = 0, chamfer_m = 0, us_per_frame = 0;
  int accepted = 0, offered = 0;
};

double F1Of(const MapScore& score) {
  const CellScores& cells = score.observable ? *score.observable : score.all;
  return cells.occupied[kDefaultToleranceCells].f1.value_or(0.0);
}

Row RowOf(const JointRun& run, const TruthRecord& truth) {
  const OccupancyMap input = InputPoseMap(run.mapping, run.options.mapper.grid);
  Row row;
  row.input_m = run.scores.slam->xy_unaligned.mean;
  row.input_f1 = F1Of(ScoreMap(truth.map, StatesOf(input), truth.observable));
  row.online_m = run.scores.online->xy_unaligned.mean;
  row.output_m = run.scores.est->xy_unaligned.mean;
  row.output_ate_m = run.scores.est->xy_se2 ? run.scores.est->xy_se2->rmse : 0.0;
  row.f1 = F1Of(run.scores.map);
  row.chamfer_m = (run.scores.map.observable ? *run.scores.map.observable : run.scores.map.all)
                      .chamfer_m.value_or(0.0);
  row.us_per_frame = 1e6 * run.mapping.cpu_s / static_cast<double>(run.mapping.reports.size());
  row.accepted = static_cast<int>(run.mapping.result.loops.size());
  row.offered = static_cast<int>(run.mapping.loops.size());
  return row;
}

using Key = std::pair<std::string, std::string>;  // case, variant

void PrintSummary(const std::vector<Key>& keys, const std::map<Key, std::vector<Row>>& rows) {
  fmt::print("\n{:28} {:18} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6} {:>6}\n",
             "case", "variant", "input", "output", "sd", "q25", "q50", "q75", "max", "ATE", "worse",
             "F1 in", "F1 out");
  for (const Key& key : keys) {
    std::vector<double> input, output, ate, f1_in, f1_out;
    double worse = 0;
    for (const Row& row : rows.at(key)) {
      input.push_back(row.input_m);
      output.push_back(row.output_m);
      ate.push_back(row.output_ate_m);
      f1_in.push_back(row.input_f1);
      f1_out.push_back(row.f1);
      worse += row.output_m > row.input_m ? 1.0 : 0.0;
    }
    const auto s = Summarise(output);
    fmt::print(
        "{:28} {:18} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:7.4f} {:6.2f} "
        "{:6.3f} {:6.3f}\n",
        key.first, key.second, Summarise(input).mean, s.mean, s.std, Percentile(output, 0.25),
        Percentile(output, 0.5), Percentile(output, 0.75), s.max, Summarise(ate).mean,
        worse / static_cast<double>(output.size()), Summarise(f1_in).mean, Summarise(f1_out).mean);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app;
  std::string study_name = "paper";
  std::vector<std::string> variant_texts, sets, only;
  RunContext context;
  int first_seed = 1, seeds = 20;
  app.add_option("--study", study_name);
  app.add_option("--variant", variant_texts)->required();
  app.add_option("--case", only, "only cases whose name contains one of these");
  app.add_option("--seeds", seeds);
  app.add_option("--first-seed", first_seed);
  app.add_option("--set", sets)->allow_extra_args(false);
  app.add_option("--threads", context.threads);
  app.add_option("--cache", context.cache_folder);
  CLI11_PARSE(app, argc, argv);
  std::vector<Variant> variants;
  for (const std::string& text : variant_texts) variants.push_back(ParseVariant(text));
  const std::string path = ResolveName(study_name, ShippedKind::kExperiment);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  std::map<Key, std::vector<Row>> rows;
  std::vector<Key> order;
  fmt::print(
      "case,variant,seed,input_m,input_f1,online_m,output_m,output_ate_m,f1,chamfer_m,"
      "loops_accepted,loops_offered,time_us_per_frame\n");
  for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
    // What shares room and images runs together.
    std::map<std::string, std::pair<std::vector<Key>, std::vector<ExperimentOptions>>> groups;
    std::vector<std::string> group_order;
    for (const Variant& variant : variants) {
      Config overrides = variant.keys;
      overrides.Set("seed", std::to_string(seed));
      for (const std::string& set : sets) overrides.Set(set);
      const Study study = ReadStudy(Config::FromFile(path), overrides, folder);
      for (std::size_t i = 0; i < study.experiments.size(); ++i) {
        const std::string& name = study.outline.cases[i].name;
        const bool wanted =
            only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& part) {
              return name.find(part) != std::string::npos;
            });
        if (!wanted) continue;
        const std::string shared = SharedPart(study.experiments[i]);
        if (!groups.contains(shared)) group_order.push_back(shared);
        groups[shared].first.push_back({name, variant.name});
        groups[shared].second.push_back(study.experiments[i]);
      }
    }
    for (const std::string& shared : group_order) {
      const auto& [keys, options] = groups.at(shared);
      const JointRuns joint = RunJointly(options, context);
      for (std::size_t i = 0; i < keys.size(); ++i) {
        const Row row = RowOf(joint.runs[i], joint.truth);
        if (!rows.contains(keys[i])) order.push_back(keys[i]);
        rows[keys[i]].push_back(row);
        fmt::print("{},{},{},{:.5f},{:.4f},{:.5f},{:.5f},{:.5f},{:.4f},{:.5f},{},{},{:.0f}\n",
                   keys[i].first, keys[i].second, seed, row.input_m, row.input_f1, row.online_m,
                   row.output_m, row.output_ate_m, row.f1, row.chamfer_m, row.accepted, row.offered,
                   row.us_per_frame);
      }
      std::fflush(stdout);
    }
  }
  PrintSummary(order, rows);
}
