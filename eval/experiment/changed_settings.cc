#include "eval/experiment/changed_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "eval/experiment/experiment_options.h"
#include "eval/experiment/idle_settings.h"
#include "eval/files/run_files.h"
#include "mapper/core/error.h"
#include "mapper/io/sequence.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {
namespace {

// All that a run.yaml of `run` or of `map` may have, files aside.
struct AllSettings {
  ExperimentOptions experiment;
  SequenceOptions sequence;

  void Visit(OptionsVisitor& v) {
    experiment.Visit(v);
    v.Group("sequence", sequence, "how the recorded sequence is read");
  }
};

AllSettings DefaultsFor(const std::string& profile) {
  AllSettings defaults;
  Config config;
  try {
    config.Set("slam.profile", profile, "run.yaml");
    config.Read(defaults);
  } catch (const InputError&) {  // of another version: its values all show
  }
  return defaults;
}

bool IsKnownElsewhere(const std::string& key, bool noise_of_profile) {
  static const std::set<std::string> kKeys = {"scene",
                                              "trajectory",
                                              "frames",
                                              "seed",
                                              "slam.profile",
                                              "sensor.noise",
                                              "mapper.method",
                                              "mapper.fusion.mode",
                                              "mapper.fusion.gain",
                                              "sequence.camera",
                                              "sequence.camera_mount",
                                              "mapper.scan.floor_z_m"};
  constexpr const char* kNoise = "mapper.fusion.slam_noise.";
  return kKeys.contains(key) ||
         (noise_of_profile && key.starts_with(kNoise) && !key.ends_with(".source"));
}

}  // namespace

std::vector<std::string> ChangedSettings(const Config& run_yaml) {
  const std::string profile = run_yaml.Text("slam.profile");
  const bool noise_of_profile = run_yaml.Text("mapper.fusion.slam_noise.source") == "profile";
  const std::string yaml = ToYaml(profile.empty() ? AllSettings() : DefaultsFor(profile));
  std::map<std::string, std::string> defaults;
  for (const auto& [key, value] : LeavesOf(Config::FromText(yaml, "defaults")))
    defaults[key] = value;
  std::vector<std::string> changed;
  for (const auto& [key, value] : LeavesOf(run_yaml)) {
    const auto usual = defaults.find(key);
    if (usual == defaults.end() || usual->second == value) continue;
    if (!IsKnownElsewhere(key, noise_of_profile)) changed.push_back(key + " " + value);
  }
  return changed;
}

namespace {

// What a setting's value comes to: a path named or left to the scene may be the same, and a seed of
// 0 is that of the run.
std::string EffectiveValue(const Config& run_yaml, const std::string& key) {
  std::string value = SettingOf(run_yaml, key);
  if (key == "trajectory") {
    const std::string hash = SettingOf(run_yaml, "provenance.trajectory_hash");
    return hash.empty() ? value : hash;
  }
  const bool is_of_run = (key == "depth_seed" || key == "slam_seed") && value == "0";
  return is_of_run ? SettingOf(run_yaml, "seed") : value;
}

// Names the path of runs that leave it to the scene as the others that take the same one do.
void NameDefaults(const std::vector<std::string>& effective, std::vector<std::string>& values) {
  const std::vector<std::string> given = values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < given.size() && values[i].empty(); ++k) {
      if (effective[k] == effective[i]) values[i] = given[k];
    }
    if (values[i].empty()) values[i] = "default";
  }
}

bool AreAllEqual(const std::vector<std::string>& values) {
  return std::equal(values.begin() + 1, values.end(), values.begin());
}

}  // namespace

std::vector<DifferingSetting> DifferingSettings(const std::vector<Config>& run_yamls) {
  std::vector<DifferingSetting> differing;
  if (run_yamls.empty()) return differing;
  for (const auto& [key, first] : LeavesOf(run_yamls.front())) {
    const bool follows = key == "scene" || key == "mapper.scan.floor_z_m" ||
                         key.starts_with("slam.") || key.starts_with("provenance.") ||
                         key.starts_with("mapper.fusion.slam_noise.");
    if (follows) continue;
    DifferingSetting setting{key, {}};
    std::vector<std::string> effective;
    for (const Config& run_yaml : run_yamls) {
      setting.values.push_back(SettingOf(run_yaml, key));
      effective.push_back(EffectiveValue(run_yaml, key));
    }
    if (AreAllEqual(setting.values) || AreAllEqual(effective)) continue;
    NameDefaults(effective, setting.values);
    differing.push_back(std::move(setting));
  }
  return differing;
}

std::string PoseSourceOf(const Config& run_yaml) {
  const std::string profile = SettingOf(run_yaml, "slam.profile");
  const SlamOptions exact = ProfileOptions(SlamProfile::kGroundTruth);
  ExperimentOptions options;
  if (profile != ValueOf(exact, "profile")) return profile;
  try {
    run_yaml.Only({"slam"}).Read(options);
  } catch (const InputError&) {  // of another version
    return profile;
  }
  options = WithoutIdleSettings(options);
  return ToYaml(options.slam) == ToYaml(exact) ? profile : "own settings over " + profile;
}

namespace {

std::string MainSettingsBut(const Config& run_yaml, const std::set<std::string>& left_out) {
  std::string text;
  const auto add_value = [&](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format(", {} {}", name, value);
  };
  const auto add = [&](const char* name, const char* key) {
    if (!left_out.contains(key)) add_value(name, SettingOf(run_yaml, key));
  };
  add("trajectory", "trajectory");
  if (!left_out.contains("slam.profile")) add_value("SLAM", PoseSourceOf(run_yaml));
  add("depth noise", "sensor.noise");
  add("seed", "seed");
  add("mapper", "mapper.method");
  add("fusion", "mapper.fusion.mode");
  if (SettingOf(run_yaml, "mapper.fusion.mode") == "fixed") add("gain", "mapper.fusion.gain");
  return text;
}

}  // namespace

std::string MainSettings(const Config& run_yaml) { return MainSettingsBut(run_yaml, {}); }

std::string MeasuredSettings(const Config& experiment, const std::set<std::string>& varied,
                             const std::string& scene_name) {
  std::vector<std::string> parts;
  const std::string scene = varied.contains("scene") ? "" : SettingOf(experiment, "scene");
  if (!scene.empty()) {
    parts.push_back(scene_name.empty() ? std::filesystem::path(scene).stem().string() : scene_name);
  }
  const std::string frames = varied.contains("frames") ? "" : SettingOf(experiment, "frames");
  if (!frames.empty() && frames != "0") parts.push_back(frames + " frames");  // 0: the whole path
  const std::string rest = MainSettingsBut(experiment, varied);
  if (!rest.empty()) parts.push_back(rest.substr(2));  // after its first comma
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace depthgrid
