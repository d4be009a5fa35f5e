#include <fmt/format.h>

#include <filesystem>

#include "eval/cli/commands.h"
#include "eval/files/run_files.h"
#include "eval/output/output_file.h"
#include "mapper/finished_map.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/map_file.h"
#include "mapper/io/mapped_files.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

// The grid settings of a run.
GridOptions GridOptionsOf(const std::string& run_yaml) {
  GridOptions options;
  Config::FromFile(run_yaml).Take("mapper").Take("grid").Read(options);
  return options;
}

// --resolution as the key that it sets, so that the key's range is checked.
Config ResolutionOf(const RegridArguments& arguments) {
  Config config;
  config.Set("resolution_m", arguments.resolution, "--resolution " + arguments.resolution);
  GridOptions only_checked;
  config.Read(only_checked);
  return config;
}

// The image that WriteMap wrote with a map; empty if there is none.
std::string ImageOfMap(const fs::path& yaml) {
  if (!fs::exists(yaml)) return "";
  const std::string text = ReadFile(yaml.string());
  for (const char* ending : {".pgm", ".scale.png"}) {
    const std::string image = fs::path(yaml).replace_extension(ending).filename().string();
    if (text.starts_with("image: " + image + "\n")) return image;
  }
  return "";
}

}  // namespace

void Regrid(const RegridArguments& arguments) {
  const Config resolution = ResolutionOf(arguments);
  const fs::path folder = arguments.folder;
  RequireRunFolder(arguments.folder);
  RequireWritable(arguments.folder);
  GridOptions options = GridOptionsOf((folder / "run.yaml").string());
  resolution.Read(options);
  const fs::path map = folder / fmt::format("map_{}.yaml", options.resolution_m);
  // The file's name contains the resolution.
  constexpr const char* kRemedy = "move it away, or --force to replace it";
  RequireNewFile(map.string(), arguments.force, kRemedy);
  RequireNewFile(MapImageOf(map.string(), arguments.map_mode), arguments.force, kRemedy);
  const std::vector<MappedFrame> frames = ReadMapped(arguments.folder);
  const std::string replaced = ImageOfMap(map.string());
  WriteMap(map.string(), DrawFinished(frames, options), arguments.map_mode);
  // In another map mode the image has another name.
  if (!replaced.empty() && replaced != ImageOfMap(map.string())) fs::remove(folder / replaced);
  fmt::print("{}\n", map.string());
}

}  // namespace depthgrid::cli
