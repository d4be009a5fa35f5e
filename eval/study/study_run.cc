#include "eval/study/study_run.h"

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "eval/doubts/experiment_doubts.h"
#include "eval/output/run_folder.h"
#include "eval/run/input_map.h"
#include "eval/run/joint_runs.h"
#include "eval/run/metrics_json.h"
#include "eval/study/study_report.h"
#include "mapper/core/cpu_clock.h"
#include "mapper/io/file.h"
#include "mapper/io/map_file.h"

namespace depthgrid {
namespace {

using Json = nlohmann::ordered_json;

// Indices of the cases that can run jointly, in the order of their first case.
std::vector<std::vector<std::size_t>> JointGroups(const Study& study) {
  std::map<std::string, std::size_t> group_of;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < study.experiments.size(); ++i) {
    const auto [entry, is_new] = group_of.emplace(SharedPart(study.experiments[i]), groups.size());
    if (is_new) groups.emplace_back();
    groups[entry->second].push_back(i);
  }
  return groups;
}

// Maps a group's progress to that of the whole.
Progress PartOf(const Progress& whole, std::size_t group, std::size_t groups) {
  if (!whole) return {};
  return [whole, group, groups](int done, int total) {
    whole(static_cast<int>(group) * total + done, static_cast<int>(groups) * total);
  };
}

// Times of a joint run, which are the same for all its cases.
struct JointTimes {
  double wall_s = 0.0;
  double cpu_s = 0.0;
};

// A case's folder, with the times of the joint run it was part of.
CaseResult WriteCase(const StudyCase& study_case, const JointRun& run, const JointRuns& joint,
                     MapMode map_mode, const OutputFolder& study_folder, const JointTimes& times) {
  const OccupancyMap input = InputPoseMap(run.mapping, run.options.mapper.grid);
  CaseResult result;
  result.name = study_case.name;
  result.published_mean_m = study_case.published_mean_m;
  result.scores = run.scores;
  result.input_map = ScoreMap(joint.truth.map, StatesOf(input), joint.truth.observable);
  result.input_map.quality =
      ScoreMapQuality(joint.truth.map, input, joint.truth.observable, run.options.metrics);
  OutputFolder folder(study_folder.File(study_case.name), false);
  RunRecord record =
      RecordOf(run.options, joint.world, run.slam, run.mapping, joint.truth, run.scores);
  const std::vector<std::string> doubts =
      DoubtsOfExperiment(joint.world, run.mapping, joint.truth, run.options);
  record.warnings.insert(record.warnings.end(), doubts.begin(), doubts.end());
  record.map_mode = map_mode;
  record.wall_s_total = times.wall_s;
  record.cpu_s_total = times.cpu_s;
  WriteMap(folder.File("input_map.yaml"), input, map_mode);
  WriteRunFolder(folder, record);
  const auto no_colour = AddColour(folder.work().string(), record);
  folder.Commit();
  result.warnings = std::move(record.warnings);
  if (no_colour) result.warnings.push_back(*no_colour);
  return result;
}

std::string SummaryJson(const std::vector<CaseResult>& results) {
  Json json;
  for (const CaseResult& result : results) {
    Json entry;
    entry["published_mean_m"] =
        result.published_mean_m ? Json(*result.published_mean_m) : Json(nullptr);
    entry.update(Json::parse(MetricsOf(result.scores)));
    entry["input_map"] = Json::parse(MetricsJson({}, &result.input_map))["map"];
    json["cases"][result.name] = std::move(entry);
  }
  return json.dump(2) + "\n";
}

}  // namespace

std::vector<CaseResult> RunStudy(const Study& study, const std::string& text, MapMode map_mode,
                                 const OutputFolder& folder, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  std::vector<CaseResult> results(study.experiments.size());
  const std::vector<std::vector<std::size_t>> groups = JointGroups(study);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto start = Clock::now();
    const double cpu_before_s = ProcessCpuS();
    std::vector<ExperimentOptions> options;
    for (const std::size_t i : groups[g]) options.push_back(study.experiments[i]);
    RunContext part = context;
    part.progress = PartOf(context.progress, g, groups.size());
    const JointRuns joint = RunJointly(options, part);
    const JointTimes times = {std::chrono::duration<double>(Clock::now() - start).count(),
                              ProcessCpuS() - cpu_before_s};
    for (std::size_t k = 0; k < groups[g].size(); ++k) {
      const std::size_t i = groups[g][k];
      results[i] = WriteCase(study.outline.cases[i], joint.runs[k], joint, map_mode, folder, times);
    }
  }
  WriteFile(folder.File("study.yaml"), text);
  std::string overrides;
  for (const std::string& override : study.overrides) overrides += override + "\n";
  WriteFile(folder.File("overrides.txt"), overrides);
  WriteFile(folder.File("metrics.json"), SummaryJson(results));
  WriteStudyReport(folder.work().string(), {folder.work().string()});
  return results;
}

}  // namespace depthgrid
