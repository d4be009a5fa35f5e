// Runs a study: every case into a run's folder, and one page for all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/experiment/study.h"
#include "eval/output/output_folder.h"
#include "eval/run/experiment.h"
#include "mapper/io/map_file.h"

namespace depthgrid {

struct CaseResult {
  std::string name;
  std::optional<double> published_mean_m;
  RunScores scores;
  MapScore input_map;  // of the map at SLAM's live poses
  std::vector<std::string> warnings;
};

// Runs the cases that share room and images jointly and writes into the folder's work area: a
// folder per case, metrics.json, study.yaml (`text`, the study as given), overrides.txt and
// report.html. The caller commits. Results are in the order of the cases.
std::vector<CaseResult> RunStudy(const Study& study, const std::string& text, MapMode map_mode,
                                 const OutputFolder& folder, const RunContext& context);

}  // namespace depthgrid
