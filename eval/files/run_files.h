// Reads a run's folder, for reports and comparisons.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "eval/files/csv_table.h"
#include "mapper/core/cell_set.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/trajectory.h"
#include "mapper/io/config.h"
#include "mapper/io/scan_file.h"

namespace depthgrid {

struct RunFiles {
  std::string folder;
  std::string settings;      // run.yaml
  std::string metrics_json;  // empty for recorded data
  std::string warnings;      // one line each
  StateMap map;
  std::optional<StateMap> input_map;  // the map at SLAM's poses; only in the folders of a study
  std::optional<StateMap> truth_map;
  std::optional<CellSet> observable;
  std::optional<Trajectory> truth;
  Trajectory slam;
  Trajectory online;
  Trajectory est;
  CsvTable frames;
  std::vector<StoredScan> scans;
  // Number of leading scans that are of the prior map (`--map`). All of them after `--localise`;
  // these keep the frame numbers of the run that made the map.
  std::size_t prior_scans = 0;
  bool only_placed = false;
};

// Throws InputError when there is no such folder or it is not a run's.
void RequireRunFolder(const std::string& folder);

// Throws InputError when the folder is not a run's or one of its files is damaged.
RunFiles ReadRunFolder(const std::string& folder);

// Margin of unknown cells shown around a map.
constexpr int kMapMarginCells = 4;

// A setting as text, with commas between the items of a list; empty if missing.
std::string SettingOf(const Config& settings, const std::string& key);

// Every setting by its key's path, in the order of the file, with its value as YAML.
std::vector<std::pair<std::string, std::string>> LeavesOf(const Config& settings,
                                                          const std::string& prefix = "");

}  // namespace depthgrid
