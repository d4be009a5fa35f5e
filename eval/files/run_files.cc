#include "eval/files/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "eval/files/one_grid.h"
#include "eval/files/one_result.h"
#include "eval/files/shell_word.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "mapper/io/map_file.h"
#include "mapper/io/trajectory_file.h"

namespace depthgrid {

namespace fs = std::filesystem;
namespace {

std::size_t PriorScansOf(const RunFiles& run) {
  if (run.only_placed) return run.scans.size();
  const auto is_prior = [](const StoredScan& scan) { return scan.frame < 0; };
  return static_cast<std::size_t>(std::count_if(run.scans.begin(), run.scans.end(), is_prior));
}

// The page overlays both, and a user may have replaced one of the maps.
void RequireOneGrid(const std::string& map_path, const StateMap& map, const std::string& other_path,
                    const std::optional<StateMap>& other) {
  if (!other) return;
  if (other->geometry.resolution_m != map.geometry.resolution_m) {
    throw InputError(
        map_path, fmt::format("resolution is {:g}, must be the {:g} of {}",
                              map.geometry.resolution_m, other->geometry.resolution_m, other_path));
  }
  OneGridAround(other->geometry, other_path, map.geometry, map_path);
}

bool IsMapYaml(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || path.extension() != ".yaml") return false;
  try {
    const Config yaml = Config::FromFile(path.string());
    return yaml.Has("image") && yaml.Has("resolution");
  } catch (const InputError&) {
    return false;  // something else
  }
}

// A map in map_server's format: `path` itself or a file in that folder; empty if there is none.
std::string MapPictureAt(const fs::path& path) {
  std::error_code error;
  if (IsMapYaml(path) || path.extension() == ".pgm") return path.string();
  std::vector<std::string> maps;
  for (const auto& entry : fs::directory_iterator(path, error)) {
    if (IsMapYaml(entry.path())) maps.push_back(entry.path().string());
  }
  return maps.empty() ? "" : *std::min_element(maps.begin(), maps.end());
}

}  // namespace

void RequireRunFolder(const std::string& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) throw InputError(folder, "no such folder");
  RequireOneResult(folder);
  if (fs::exists(fs::path(folder) / "run.yaml", error)) return;
  if (fs::exists(fs::path(folder) / "depth.txt", error)) {
    throw InputError(folder,
                     fmt::format("is a sequence, no run's folder; `depthgrid map {} -o OUT` makes "
                                 "a run of it",
                                 ShellWord(folder)));
  }
  const std::string picture = MapPictureAt(folder);
  if (picture.empty()) throw InputError(folder, "is no run's folder: it has no run.yaml");
  const fs::path around = fs::path(picture).parent_path();
  if (!fs::exists(around / "run.yaml", error) && fs::exists(around / "scans.bin", error)) {
    throw InputError((around / "run.yaml").string(),
                     "is missing: the folder holds a run's scans (scans.bin), not the settings "
                     "that they were made with");
  }
  throw InputError(
      picture,
      fs::exists(around / "run.yaml", error)
          ? fmt::format("is a run's picture, must be the folder that it is in, {}",
                        around.empty() ? "." : around.string())
          : "is a finished picture, as map_server's maps are, without the scans that it was drawn "
            "from; must be the folder of a run of depthgrid (with a run.yaml)");
}

RunFiles ReadRunFolder(const std::string& folder) {
  const auto path = [&](const char* name) { return (fs::path(folder) / name).string(); };
  const auto exists = [&](const char* name) { return fs::exists(path(name)); };
  RequireRunFolder(folder);
  RunFiles run;
  run.folder = folder;
  run.settings = ReadFile(path("run.yaml"));
  if (exists("metrics.json")) run.metrics_json = ReadFile(path("metrics.json"));
  if (exists("warnings.txt")) run.warnings = ReadFile(path("warnings.txt"));
  run.map = ReadStates(path("map.yaml"));
  if (exists("input_map.yaml")) run.input_map = ReadStates(path("input_map.yaml"));
  if (exists("truth_map.yaml")) run.truth_map = ReadStates(path("truth_map.yaml"));
  RequireOneGrid(path("map.yaml"), run.map, path("input_map.yaml"), run.input_map);
  RequireOneGrid(path("map.yaml"), run.map, path("truth_map.yaml"), run.truth_map);
  if (exists("observable.yaml")) run.observable = ReadFreeCells(path("observable.yaml"));
  if (exists("trajectory_truth.txt")) run.truth = ReadTrajectory(path("trajectory_truth.txt"));
  run.slam = ReadTrajectoryFile(path("trajectory_slam.txt")).poses;
  run.online = ReadTrajectoryFile(path("trajectory_online.txt")).poses;
  run.est = ReadTrajectoryFile(path("trajectory_est.txt")).poses;
  run.frames = ReadCsv(path("frames.csv"));
  if (exists("scans.bin")) run.scans = ReadScans(path("scans.bin"));
  const Config settings = Config::FromText(run.settings, path("run.yaml"));
  run.only_placed = SettingOf(settings, "localise") == "true";
  run.prior_scans = PriorScansOf(run);
  return run;
}

std::string SettingOf(const Config& settings, const std::string& key) {
  if (!settings.HasList(key)) return settings.Text(key);
  return fmt::format("{}", fmt::join(settings.List(key), ", "));
}

std::vector<std::pair<std::string, std::string>> LeavesOf(const Config& settings,
                                                          const std::string& prefix) {
  std::vector<std::pair<std::string, std::string>> leaves;
  for (const ConfigEntry& entry : settings.Entries()) {
    if (!entry.map) {
      leaves.emplace_back(prefix + entry.key, entry.text);
      continue;
    }
    const auto below = LeavesOf(*entry.map, prefix + entry.key + ".");
    leaves.insert(leaves.end(), below.begin(), below.end());
  }
  return leaves;
}

}  // namespace depthgrid
