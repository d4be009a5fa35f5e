#include "eval/run/prior_run.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "eval/files/csv_table.h"
#include "eval/files/hash.h"
#include "eval/files/run_files.h"
#include "mapper/core/error.h"
#include "mapper/core/median.h"
#include "mapper/io/config.h"
#include "mapper/io/file.h"
#include "mapper/io/mapped_files.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

bool ShapesMap(const std::string& key) {
  return key == "mapper.method" || key.starts_with("mapper.grid.");
}

// The floor's height belongs to the room, not to the mapper's settings.
bool ShapesMapOfImages(const std::string& key) {
  return ShapesMap(key) || (key.starts_with("mapper.scan.") && key != "mapper.scan.floor_z_m");
}

// The part of run.yaml that is checked here.
struct MapperSettings {
  MapperOptions mapper;

  void Visit(OptionsVisitor& v) { v.Group("mapper", mapper, "the mapper"); }
};

// Keys of other versions are ignored.
void RequirePossible(const Config& run) {
  Config known;
  for (const std::string& key : KeyPathsOf(MapperSettings{})) {
    if (!ShapesMapOfImages(key) || !run.Has(key) || run.HasList(key)) continue;
    known.Set(key, run.Text(key), run.PlaceOfKey(key));
  }
  MapperSettings settings;
  known.Read(settings);
}

}  // namespace

PriorMap ReadPriorRun(const std::string& folder) {
  RequireRunFolder(folder);
  RequirePossible(Config::FromFile((fs::path(folder) / "run.yaml").string()));
  PriorMap prior;
  prior.frames = ReadMapped(folder);
  return prior;
}

std::string HashOfPriorRun(const std::string& folder) {
  ContentHash hash;
  for (const std::string& path :
       {(fs::path(folder) / "scans.bin").string(), MatchedFileOf(folder)}) {
    if (fs::exists(path)) hash.Text(ReadFile(path));
  }
  return hash.Hex();
}

std::optional<std::string> DoubtOfPrior(const std::string& folder, const MapperOptions& options,
                                        bool images) {
  const std::string path = (fs::path(folder) / "run.yaml").string();
  const Config prior = Config::FromFile(path);
  const MapperSettings settings{options};
  const Config now = Config::FromText(ToYaml(settings), "settings");
  std::vector<std::string> there, here;
  for (const std::string& key : KeyPathsOf(settings)) {
    const bool shapes = images ? ShapesMapOfImages(key) : ShapesMap(key);
    if (!shapes || !prior.Has(key)) continue;
    const std::string made_with = SettingOf(prior, key);
    const std::string value = SettingOf(now, key);
    if (made_with == value) continue;
    there.push_back(key + "=" + made_with);
    here.push_back(value);
  }
  if (there.empty()) return {};
  return fmt::format("{}: the map was made with {}, and here it is {}: give the same --set", path,
                     fmt::join(there, ", "), fmt::join(here, ", "));
}

std::optional<double> CameraHeightOfPrior(const std::string& folder) {
  const fs::path run(folder);
  const std::string frames = (run / "frames.csv").string();
  if (Config::FromFile((run / "run.yaml").string()).Text("localise") == "true") return {};
  std::vector<double> heights_m;
  try {
    heights_m = ReadCsv(frames).Column("camera_height_m");
  } catch (const InputError&) {
    return {};  // missing, damaged or of an earlier version: nothing else needs it
  }
  std::erase_if(heights_m, [](double height_m) { return std::isnan(height_m); });
  if (heights_m.empty()) return {};
  return UpperMedian(std::move(heights_m));
}

}  // namespace depthgrid
