// The cases of a study over many seeds, mapped in several ways: the tables of docs/results.md, "The
// paper's experiment". Results, not times.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "bench/command_line.h"
#include "bench/guarded_main.h"
#include "eval/experiment/shipped.h"
#include "eval/experiment/study.h"
#include "eval/metrics/statistics.h"
#include "eval/run/joint_runs.h"
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"

using namespace depthgrid;

namespace {

// A mapper configuration: its name and keys, from "name key=value key=value".
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
  double final_m = 0, final_f1 = 0;  // SLAM's final trajectory and its map (without matching)
  double online_m = 0, output_m = 0, output_ate_m = 0, f1 = 0, thickness_m = 0, us_per_frame = 0;
  int accepted = 0, offered = 0;
};

double F1Of(const MapScore& score) {
  const CellScores& cells = score.observable ? *score.observable : score.all;
  return cells.occupied[kDefaultToleranceCells].f1.value_or(0.0);
}

double F1At(const std::vector<Pose2>& poses, const JointRun& run, const TruthRecord& truth) {
  MapDrawing drawing(run.options.mapper.grid);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    drawing.Add(*run.mapping.result.mapped[i].obstacles, poses[i]);
  }
  return F1Of(ScoreMap(truth.map, StatesOf(drawing.Map()), truth.observable));
}

Row RowOf(const JointRun& run, const TruthRecord& truth) {
  if (run.slam.final.size() != run.slam.live.size()) {
    throw InputError("--study", "SLAM loses track in it, and poses are compared frame by frame");
  }
  std::vector<Pose2> live, final;
  for (const MappedFrame& mapped : run.mapping.result.mapped) {
    const auto frame = static_cast<std::size_t>(mapped.frame);
    live.push_back(BaseOf(*run.slam.live[frame].slam_from_camera));
    final.push_back(BaseOf(run.slam.final[frame].world_from_camera));
  }
  Row row;
  row.input_m = run.scores.slam->xy_unaligned.mean;
  row.input_f1 = F1At(live, run, truth);
  row.final_m = ScoreTrajectory(truth.trajectory, run.slam.final)->xy_unaligned.mean;
  row.final_f1 = F1At(final, run, truth);
  row.online_m = run.scores.online->xy_unaligned.mean;
  row.output_m = run.scores.est->xy_unaligned.mean;
  row.output_ate_m = run.scores.est->xy_se2 ? run.scores.est->xy_se2->rmse : 0.0;
  row.f1 = F1Of(run.scores.map);
  const auto& thickness = run.scores.map.quality->thickness;
  row.thickness_m = thickness ? thickness->mean_m : 0.0;
  row.us_per_frame = 1e6 * run.mapping.cpu_s / static_cast<double>(run.mapping.reports.size());
  row.accepted = static_cast<int>(run.mapping.result.loops.size());
  row.offered = static_cast<int>(run.mapping.loops.size());
  return row;
}

using Key = std::pair<std::string, std::string>;  // case, variant

struct Group {
  std::vector<Key> keys;
  std::vector<int> seeds;
  std::vector<ExperimentOptions> options;
};

double MeanOf(const std::vector<Row>& rows, double Row::*value) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(row.*value);
  return Summarise(values).mean;
}

void PrintSummary(const std::vector<Key>& keys, const std::map<Key, std::vector<Row>>& rows) {
  fmt::print(
      "\n{:28} {:12}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>6}{:>6}{:>7}{:>7}\n",
      "case", "variant", "input", "final", "output", "sd", "q25", "q50", "q75", "max", "ATE",
      "worse", "F1 in", "F1 fi", "F1 out", "thick");
  for (const Key& key : keys) {
    const std::vector<Row>& of_key = rows.at(key);
    std::vector<double> output;
    double worse = 0;
    for (const Row& row : of_key) {
      output.push_back(row.output_m);
      worse += row.output_m > row.input_m ? 1.0 : 0.0;
    }
    const auto s = Summarise(output);
    fmt::print(
        "{:28} {:12}{:7.3f}{:7.3f}{:7.4f}{:7.4f}{:7.4f}{:7.4f}{:7.4f}{:7.4f}{:7.4f}{:7.2f}{:6.3f}"
        "{:6.3f}{:7.3f}{:7.3f}\n",
        key.first, key.second, MeanOf(of_key, &Row::input_m), MeanOf(of_key, &Row::final_m), s.mean,
        s.std, Percentile(output, 0.25), Percentile(output, 0.5), Percentile(output, 0.75), s.max,
        MeanOf(of_key, &Row::output_ate_m), worse / static_cast<double>(output.size()),
        MeanOf(of_key, &Row::input_f1), MeanOf(of_key, &Row::final_f1), MeanOf(of_key, &Row::f1),
        MeanOf(of_key, &Row::thickness_m));
  }
}

struct Choice {
  std::string study = "paper";
  std::vector<Variant> variants;
  std::vector<std::string> sets;
  std::vector<std::string> only;  // cases whose name contains one of these; none: all
  int first_seed = 1;
  int seeds = 20;
  int depth_seed = 1;

  bool Has(const std::string& name) const {
    return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& part) {
             return name.find(part) != std::string::npos;
           });
  }
};

Config OverridesOf(const Choice& choice, const Variant& variant, int seed) {
  Config overrides = variant.keys;
  overrides.Set("seed", std::to_string(seed));
  overrides.Set("depth_seed", std::to_string(choice.depth_seed));
  for (const char* dear : {"registration", "ssim", "navigation"}) {
    overrides.Set(std::string("metrics.") + dear, "false");
  }
  for (const std::string& set : choice.sets) overrides.Set(set);
  return overrides;
}

// Groups of cases that share room and images and so run together.
std::map<std::string, Group> GroupsOf(const Choice& choice) {
  const std::string path = ResolveName(choice.study, ShippedKind::kExperiment);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  std::map<std::string, Group> groups;
  for (int seed = choice.first_seed; seed < choice.first_seed + choice.seeds; ++seed) {
    for (const Variant& variant : choice.variants) {
      const Study study =
          ReadStudy(Config::FromFile(path), OverridesOf(choice, variant, seed), folder);
      for (std::size_t i = 0; i < study.experiments.size(); ++i) {
        const std::string& name = study.outline.cases[i].name;
        if (!choice.Has(name)) continue;
        Group& group = groups[SharedPart(study.experiments[i])];
        group.keys.push_back({name, variant.name});
        group.seeds.push_back(seed);
        group.options.push_back(study.experiments[i]);
      }
    }
  }
  return groups;
}

void PrintRow(const Key& key, int seed, const Row& row) {
  fmt::print(
      "{},{},{},{:.5f},{:.4f},{:.5f},{:.4f},{:.5f},{:.5f},{:.5f},{:.4f},{:.4f},{},{},{:.0f}\n",
      key.first, key.second, seed, row.input_m, row.input_f1, row.final_m, row.final_f1,
      row.online_m, row.output_m, row.output_ate_m, row.f1, row.thickness_m, row.accepted,
      row.offered, row.us_per_frame);
}

int Measure(int argc, char** argv) {
  CLI::App app;
  Choice choice;
  std::vector<std::string> variant_texts;
  RunContext context;
  app.add_option("--study", choice.study);
  app.add_option("--variant", variant_texts)->required();
  app.add_option("--case", choice.only, "only cases whose name contains one of these");
  app.add_option("--seeds", choice.seeds)->check(FromTo(1, 1e6));
  app.add_option("--first-seed", choice.first_seed)->check(FromTo(0, 1e9));
  app.add_option("--depth-seed", choice.depth_seed,
                 "of the depth noise, the same for all seeds of SLAM")
      ->check(FromTo(0, 1e9));
  app.add_option("--set", choice.sets)->allow_extra_args(false);
  app.add_option("--threads", context.threads)->check(FromTo(1, 1024));
  app.add_option("--cache", context.cache_folder);
  if (!ReadCommandLine(app, argc, argv)) return 0;
  for (const std::string& text : variant_texts) choice.variants.push_back(ParseVariant(text));
  context.progress = [](int done, int total) {
    if (done % 100 == 0) fmt::print(stderr, "{} of {} frames\n", done, total);
  };
  const std::map<std::string, Group> groups = GroupsOf(choice);
  fmt::print(
      "case,variant,seed,input_m,input_f1,final_m,final_f1,online_m,output_m,output_ate_m,f1,"
      "thickness_m,loops_accepted,loops_offered,time_us_per_frame\n");
  std::map<Key, std::vector<Row>> rows;
  std::vector<Key> order;
  for (const auto& [shared, group] : groups) {
    const JointRuns joint = RunJointly(group.options, context);
    for (std::size_t i = 0; i < group.keys.size(); ++i) {
      const Key& key = group.keys[i];
      const Row row = RowOf(joint.runs[i], joint.truth);
      if (!rows.contains(key)) order.push_back(key);
      rows[key].push_back(row);
      PrintRow(key, group.seeds[i], row);
    }
  }
  PrintSummary(order, rows);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return depthgrid::GuardedMain(Measure, argc, argv); }
