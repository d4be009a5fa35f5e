// How much of an experiment's error each stage owns: the truth is put in for each in turn
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

// Which stages work on the truth instead of their input.
struct TrueStages {
  bool poses = false;      // SLAM's poses
  bool depth = false;      // depth images without noise
  bool converter = false;  // scans cast in the room: neither noise nor conversion
  bool matcher = false;    // the true pose for every matched one
  bool loops = false;      // SLAM closes every revisit, at once and almost exactly
};

struct AblationVariant {
  std::string name;
  TrueStages truth;
  std::string against;  // the variant whose difference from this one is the stage's own
  std::string meaning;
};

// The experiment as it is, one variant a stage, and all of them at once.
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
  std::vector<std::string> warnings;  // what is amiss with the path, the truth and what is seen
};

// Every variant with every seed, by seed; `progress` counts frames.
AblationResult RunAblation(const AblationPlan& plan, const RunContext& context);

// What a stage owns of one score's error.
struct StageShare {
  std::string variant;
  double error = 0.0;     // mean over seeds with this truth put in
  PairedComparison gain;  // this variant against the one it is compared with; b - a is negative
  // Mean error owned / mean error of the experiment as it is; empty where that has none.
  std::optional<double> share;
  double p_holm = 1.0;  // over the stages
};

struct ErrorShares {
  std::string metric;
  bool is_complement = false;  // the error is one less the score
  double error = 0.0;          // of the experiment as it is
  std::vector<StageShare> stages;
};

// Less the seeds that give what an earlier one gave in every variant and score, as where nothing is
// random or a seed of its own holds it still: counted again they would make sure what is not.
std::vector<AblationRun> WithoutRepeatedSeeds(const std::vector<AblationRun>& runs);

// For the scores that say most; those not defined in every run are left out.
std::vector<ErrorShares> SharesOf(const std::vector<AblationRun>& runs);

std::string AblationCsv(const std::vector<AblationRun>& runs);
std::string AblationJson(const std::vector<ErrorShares>& shares, std::size_t seeds);

}  // namespace depthgrid
