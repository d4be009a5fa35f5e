#include "eval/sweep/sweep_experiment.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "eval/experiment/experiment_options.h"
#include "eval/experiment/shipped.h"

namespace depthgrid {

namespace fs = std::filesystem;

ExperimentFile ReadExperimentFile(const std::string& name, const std::string& place,
                                  const std::string& sweep_folder) {
  ExperimentFile file;
  file.path = ResolveNameAt(place, name, ShippedKind::kExperiment, sweep_folder);
  // A shipped experiment names no files, so the names are those in the sweep's file.
  file.folder = IsFileName(name) ? fs::path(file.path).parent_path().string() : sweep_folder;
  file.config = Config::FromFile(file.path);
  file.record = file.config.Take("provenance");
  // Read here so that errors name this file and its lines, which a copy does not have.
  ReadExperiment(Config::FromFile(file.path), file.folder);
  return file;
}

Config Changed(Config config, const Config& fixed, const std::vector<std::string>& set) {
  for (const ConfigEntry& entry : fixed.Entries()) config.Set(entry.key, entry.text, entry.place);
  for (const std::string& assignment : set) config.Set(assignment);
  return config;
}

std::map<std::string, std::string> PlacesOf(const Config& experiment, const Config& changes,
                                            const std::vector<SweepAxis>& axes) {
  std::map<std::string, std::string> places;
  for (const std::string& key : KeyPathsOf(ExperimentOptions{})) {
    places[key] = PlaceOfKey({&experiment, &changes}, key);
  }
  for (const SweepAxis& axis : axes) {
    for (const std::string& key : axis.keys) places[key] = axis.place;
  }
  return places;
}

std::string GivenText(const Config& effective, const Config& base, const std::string& prefix) {
  std::string text;
  for (const ConfigEntry& entry : effective.Entries()) {
    const std::string path = prefix + entry.key;
    if (!base.Has(path)) continue;
    text += entry.map ? GivenText(*entry.map, base, path + ".")
                      : fmt::format("{}: {}\n", path, entry.text);
  }
  return text;
}

}  // namespace depthgrid
