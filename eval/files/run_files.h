// A run's folder read back: what reports, comparisons and other later looks at a run need.
#pragma once

#include <optional>
#include <string>
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
  std::string warnings;      // a line each
  StateMap map;
  std::optional<StateMap> input_map;  // in the folders of a study: SLAM's poses alone
  std::optional<StateMap> truth_map;
  std::optional<CellSet> observable;
  std::optional<Trajectory> truth;
  Trajectory slam;
  Trajectory online;
  Trajectory est;
  CsvTable frames;
  std::vector<StoredScan> scans;
  // So many of them, the first, are of the finished map that the run went on in (`--map`): all when
  // it was only placed there (`--localise`), which keeps the numbers of the run that made the map.
  std::size_t prior_scans = 0;
  bool only_placed = false;
};

// Throws InputError when there is no such folder, or it is no run's.
void RequireRunFolder(const std::string& folder);

// Throws InputError when the folder is no run's, or a file of it is damaged.
RunFiles ReadRunFolder(const std::string& folder);

// How much of the unknown is shown around a map.
constexpr int kMapMarginCells = 4;

// A setting as text, the items of a list with commas between; empty when it is not there or empty.
std::string SettingOf(const Config& settings, const std::string& key);

}  // namespace depthgrid
