#include <fmt/format.h>

#include <filesystem>

#include "eval/cli/commands.h"
#include "mapper/core/error.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/io/config.h"
#include "mapper/io/map_file.h"
#include "mapper/io/scan_file.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

// The grid settings a run used; all else of run.yaml does not matter here.
GridOptions GridOptionsOf(const std::string& run_yaml) {
  GridOptions options;
  Config::FromFile(run_yaml).Take("mapper").Take("grid").Read(options);
  return options;
}

// --resolution with the range of the key it stands for.
void SetResolution(GridOptions& options, double resolution_m) {
  Config config;
  const std::string value = fmt::format("{}", resolution_m);
  config.Set("resolution_m", value, "--resolution " + value);
  config.Read(options);
}

}  // namespace

void Regrid(const RegridArguments& arguments) {
  const fs::path folder = arguments.folder;
  if (!fs::exists(folder / "run.yaml")) {
    throw InputError(arguments.folder, "is no run's folder: it has no run.yaml");
  }
  GridOptions options = GridOptionsOf((folder / "run.yaml").string());
  SetResolution(options, arguments.resolution_m);
  const std::vector<StoredScan> scans = ReadScans((folder / "scans.bin").string());
  if (scans.empty()) throw InputError((folder / "scans.bin").string(), "holds no scan");
  MapDrawing drawing(options);
  for (const StoredScan& stored : scans) drawing.Add(*stored.scan, stored.map_from_base);
  const fs::path map = folder / fmt::format("map_{}.yaml", arguments.resolution_m);
  WriteMap(map.string(), drawing.Map(), arguments.map_mode);
  fmt::print("{}\n", map.string());
}

}  // namespace depthgrid::cli
