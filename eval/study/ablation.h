// How much of an experiment's error each stage causes: each in turn is replaced by the truth
// (docs/statistics.md, "Ablation").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/run/experiment.h"
#include "eval/statistics/paired_comparison.h"

namespace depthgrid {

// The stages that are replaced by the truth.
struct TrueStages {
  bool poses = false;      // SLAM's poses
  bool depth = false;      // depth images without noise
  bool converter = false;  // scans cast in the room: neither noise nor conversion
  bool matcher = false;    // the true pose for every matched one
  bool loops = false;      // SLAM closes every loop, at once and almost exactly
};

struct AblationVariant {
  std::string name;
  TrueStages truth;
  std::string against;  // the variant whose difference from this one is the stage's effect
  std::string meaning;
};

// The unchanged experiment, one variant per stage, and all stages together.
const std::vector<AblationVariant>& AblationVariants();

struct AblationRun {
  std::string variant;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, double>> metrics;  // of metrics.json
};

struct AblationPlan {
  ExperimentOptions experiment;
  std::vector<std::uint64_t> seeds;
};

struct AblationResult {
  std::vector<AblationRun> runs;
  std::vector<std::string> warnings;  // about the path, the truth and what is seen
};

// Runs every variant with every seed, ordered by seed; `progress` counts frames.
AblationResult RunAblation(const AblationPlan& plan, const RunContext& context);

// The part of one score's error that a stage causes.
struct StageShare {
  std::string variant;
  double error = 0.0;     // mean over seeds, with the stage replaced by the truth
  PairedComparison gain;  // this variant against the one it is compared with; b - a is negative
  // Mean decrease of the error / mean error of the unchanged experiment; empty where that is zero.
  std::optional<double> share;
  double p_holm = 1.0;  // over the stages
};

struct ErrorShares {
  std::string metric;
  bool is_complement = false;  // the error is 1 - score
  double error = 0.0;          // of the unchanged experiment
  std::vector<StageShare> stages;
};

// Removes seeds that give the same as an earlier one in every variant and score, as where nothing
// is random or a separate seed fixes it: counted again they would make results look more
// significant.
std::vector<AblationRun> WithoutRepeatedSeeds(const std::vector<AblationRun>& runs);

// For ScoresOfAnAblation(), without scores that are undefined in any run.
std::vector<ErrorShares> SharesOf(const std::vector<AblationRun>& runs);

std::string AblationCsv(const std::vector<AblationRun>& runs);
// `scene`: the room's name.
std::string AblationJson(const std::vector<ErrorShares>& shares, std::size_t seeds,
                         const std::string& scene);

}  // namespace depthgrid
