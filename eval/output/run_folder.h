// The folder of a run (docs/run_folder.md): all that `run` and `map` leave behind.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/output/output_folder.h"
#include "eval/run/experiment.h"
#include "mapper/core/slam_output.h"
#include "mapper/io/map_file.h"

namespace depthgrid {

struct RunRecord {
  std::string settings;               // YAML of every effective key
  std::vector<std::string> warnings;  // what was wrong with the input and survived
  const MappingRun* mapping = nullptr;
  const SlamOutput* slam = nullptr;    // nothing for recorded data without events
  const TruthRecord* truth = nullptr;  // nothing for recorded data
  const RunScores* scores = nullptr;
  const World* world = nullptr;  // nothing for recorded data
  ScanOptions scan;              // the mapper's
  MapMode map_mode = MapMode::kTrinary;
  std::string map_hash;  // of the finished map that it went on from; empty: none
  double wall_s_total = 0.0;
  double cpu_s_total = 0.0;
};

// The record of a run in a simulated room. It borrows; times are still to be filled in.
RunRecord RecordOf(const ExperimentOptions& options, const World& world, const SlamOutput& slam,
                   const MappingRun& mapping, const TruthRecord& truth, const RunScores& scores);

// A run that mapped nothing still has a map: one unknown cell.
OccupancyMap MapToWrite(const OccupancyMap& map);

// Writes every file into the folder's work area; the caller commits.
void WriteRunFolder(const OutputFolder& folder, const RunRecord& record);

// Puts the pictures in colour into a run's folder, and its page anew: apart, for the library that
// draws them may be missing, or end the program when memory is short. Returns why there are
// none; the run stays as it was.
std::optional<std::string> AddColour(const std::string& folder, const RunRecord& record);

// metrics.json of a run.
std::string MetricsOf(const RunScores& scores);

// Version and instruction sets, as in every run.yaml. `world`: null for recorded data.
std::string Provenance(const World* world);

}  // namespace depthgrid
