#include "eval/cli/experiment_argument.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "eval/doubts/record_check.h"
#include "eval/experiment/camera_doubts.h"
#include "eval/experiment/idle_settings.h"
#include "eval/experiment/shipped.h"
#include "mapper/core/error.h"
#include "sim/mesh/mesh_file.h"

namespace depthgrid::cli {
namespace {

namespace fs = std::filesystem;

ExperimentOptions Read(Config config, const std::vector<std::string>& set,
                       const std::string& base_folder) {
  for (const std::string& assignment : set) config.Set(assignment);
  return ReadExperiment(std::move(config), base_folder);
}

}  // namespace

Config ExperimentFile(const std::string& path) {
  if (IsMeshFile(path)) {
    throw InputError(path, "is a mesh; an experiment is a YAML file that names it as its scene");
  }
  Config config = Config::FromFile(path);
  if (config.Has("shapes") && !config.Has("scene")) {
    throw InputError(path, "is a scene; an experiment is a YAML file that names it as its scene");
  }
  if (config.Has("input") && !config.Has("scene")) {
    throw InputError(path, "is the run.yaml of a map; `depthgrid map` takes it");
  }
  if (config.Has("axes") && !config.Has("scene")) {
    throw InputError(path, "is a sweep; `depthgrid sweep` takes it");
  }
  return config;
}

bool IsExperiment(const std::string& name) {
  const auto shipped =
      IsFileName(name) ? std::vector<std::string>{} : ShippedNames(ShippedKind::kExperiment);
  if (std::find(shipped.begin(), shipped.end(), name) != shipped.end()) return true;
  const std::string path = ResolveName(name, ShippedKind::kScene);
  const bool is_yaml = path.ends_with(".yaml") || path.ends_with(".yml");
  return is_yaml && Config::FromFile(path).Has("scene");
}

namespace {

std::optional<std::string> DoubtOfProfile(const std::string& name,
                                          const std::vector<std::string>& set) {
  Config given;
  for (const std::string& assignment : set) given.Set(assignment);
  if (!given.Has("slam.profile")) return {};
  const std::string profile = given.Text("slam.profile");
  const std::vector<std::string> kept = KeptBesideProfile(
      ExperimentFile(ResolveName(name, ShippedKind::kExperiment)), given, {profile});
  if (kept.empty()) return {};
  return fmt::format("{}: its own values of {} are kept with slam.profile={}", name,
                     fmt::join(kept, ", "), profile);
}

// Adds warnings about overrides and settings of a user's file without effect.
void AddIdle(const std::string& name, const std::vector<std::string>& set,
             const IdleSettingList& idle, std::vector<std::string>& doubts) {
  const auto add = [&](const std::vector<std::string>& more) {
    doubts.insert(doubts.end(), more.begin(), more.end());
  };
  add(DoubtsOfOverrides(set, idle, [&](const std::vector<std::string>& some) {
    return ToYaml(ExperimentOrScene(name, some));
  }));
  // Shipped experiments are correct, even if --set makes some of their settings idle.
  if (!IsFileName(name) || !IsExperiment(name)) return;
  Config overrides;
  for (const std::string& assignment : set) overrides.Set(assignment);
  const Config file = ExperimentFile(name);
  add(DoubtsOfFile(
      file, idle,
      [&file] {
        ExperimentOptions alone;
        file.Read(alone);
        return alone;
      },
      [&overrides](const std::string& key) { return overrides.Has(key); }));
}

}  // namespace

std::vector<std::string> DoubtsOfRecord(const std::string& name,
                                        const std::vector<std::string>& set) {
  if (!IsExperiment(name)) return {};
  const std::string path = ResolveName(name, ShippedKind::kExperiment);
  Config given;
  for (const std::string& assignment : set) given.Set(assignment);
  Config file = ExperimentFile(path);
  // A file with the same name counts as the same room at another path, as when someone else repeats
  // a run.
  const auto name_of = [](const Config& config) {
    return fs::path(config.Text("scene")).filename();
  };
  const bool other_scene = given.Has("scene") && name_of(given) != name_of(file);
  return depthgrid::DoubtsOfRecord(path, file.Take("provenance"), ExperimentNamed(name, set),
                                   {other_scene, given.Has("trajectory")});
}

std::vector<std::string> DoubtsOfSettings(const std::string& name,
                                          const std::vector<std::string>& set) {
  std::vector<std::string> doubts = DoubtsOfRecord(name, set);
  const ExperimentOptions options = ExperimentNamed(name, set);
  const std::vector<std::string> of_camera = DoubtsOfCamera(options.sensor);
  doubts.insert(doubts.end(), of_camera.begin(), of_camera.end());
  std::vector<std::string> of_keys;
  AddIdle(name, set, IdleSettings(options), of_keys);
  // A profile that sets nothing at all is already reported there.
  const bool sets_nothing = std::any_of(of_keys.begin(), of_keys.end(), [](const auto& doubt) {
    return doubt.starts_with("--set slam.profile=");
  });
  if (!sets_nothing) {
    if (const auto doubt = DoubtOfProfile(name, set)) doubts.push_back(*doubt);
  }
  doubts.insert(doubts.end(), of_keys.begin(), of_keys.end());
  return doubts;
}

std::vector<std::string> DoubtsOfImages(const std::string& name,
                                        const std::vector<std::string>& set) {
  std::vector<std::string> doubts = DoubtsOfRecord(name, set);
  const ExperimentOptions options = ExperimentOrScene(name, set);
  const std::vector<std::string> of_camera = DoubtsOfCamera(options.sensor);
  doubts.insert(doubts.end(), of_camera.begin(), of_camera.end());
  IdleSettingList idle = IdleSettings(options);
  std::erase_if(idle, [](const IdleSetting& setting) {
    return !setting.key.starts_with("sensor.") && !setting.key.ends_with("seed");
  });
  AddIdle(name, set, idle, doubts);
  return doubts;
}

ExperimentOptions ExperimentNamed(const std::string& name, const std::vector<std::string>& set) {
  const std::string path = ResolveName(name, ShippedKind::kExperiment);
  return Read(ExperimentFile(path), set, fs::path(path).parent_path().string());
}

ExperimentOptions ExperimentOrScene(const std::string& name, const std::vector<std::string>& set) {
  if (IsExperiment(name)) return ExperimentNamed(name, set);
  Config config;
  config.Set("scene", name);
  return Read(std::move(config), set, "");
}

KeyPlaces PlacesOf(const std::string& name, const std::vector<std::string>& set) {
  return [name, set](const std::string& key) {
    Config config;
    if (IsExperiment(name)) config = ExperimentFile(ResolveName(name, ShippedKind::kExperiment));
    for (const std::string& assignment : set) config.Set(assignment);
    return PlaceOfKey({&config}, key);
  };
}

std::vector<std::string> InputsOf(const std::string& name,
                                  const std::vector<ExperimentOptions>& experiments) {
  std::vector<std::string> names = {name};
  for (const ExperimentOptions& experiment : experiments) {
    names.push_back(experiment.scene);
    names.push_back(experiment.trajectory);
  }
  std::erase_if(names, [](const std::string& some) { return !IsFileName(some); });
  return names;
}

void RequireNotSet(const std::vector<std::string>& set, const std::string& key,
                   const std::string& instead) {
  for (const std::string& assignment : set) {
    Config config;
    config.Set(assignment);
    if (config.Has(key)) throw InputError(config.PlaceOfKey(key), instead);
  }
}

std::string CacheFolder(const CommonArguments& arguments) {
  if (arguments.no_cache) return "";
  if (!arguments.cache.empty()) return arguments.cache;
  const char* folder = std::getenv("DEPTHGRID_CACHE");
  return folder != nullptr ? folder : "";
}

void RequireCacheElsewhere(const CommonArguments& arguments) {
  const std::string cache = CacheFolder(arguments);
  if (cache.empty() || arguments.output.empty()) return;
  const auto plain = [](const std::string& path) {
    std::error_code error;  // errors are reported when the folder is used
    const fs::path resolved = fs::weakly_canonical(fs::absolute(path), error);
    return resolved.has_filename() ? resolved : resolved.parent_path();
  };
  const fs::path relative = plain(cache).lexically_relative(plain(arguments.output));
  if (relative.empty() || *relative.begin() == "..") return;
  throw InputError(
      (arguments.cache.empty() ? "DEPTHGRID_CACHE " : "--cache ") + cache,
      fmt::format("is a place in {}, the output, must be one beside it", arguments.output));
}

}  // namespace depthgrid::cli
