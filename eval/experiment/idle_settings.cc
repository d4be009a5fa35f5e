#include "eval/experiment/idle_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "eval/experiment/default_values.h"
#include "eval/experiment/shipped.h"

namespace depthgrid {
namespace {

struct StatedKey {
  std::string key;
  std::string place;
  std::string text;
};

// They set other keys, except those that are given.
constexpr std::array<std::string_view, 2> kPresets = {"slam.profile", "slam.loops.scenario"};

// The values of a tree, with their full paths.
void AddStated(const Config& config, const std::string& prefix, std::vector<StatedKey>& stated) {
  for (const ConfigEntry& entry : config.Entries()) {
    if (entry.map) {
      AddStated(*entry.map, prefix + entry.key + ".", stated);
    } else {
      stated.push_back({prefix + entry.key, entry.place, entry.text});
    }
  }
}

std::vector<StatedKey> StatedKeys(const Config& config) {
  std::vector<StatedKey> stated;
  AddStated(config, "", stated);
  return stated;
}

const IdleSetting* Find(const IdleSettingList& idle, const std::string& key) {
  const auto found = std::find_if(idle.begin(), idle.end(), [&](const IdleSetting& setting) {
    return key == setting.key || key.starts_with(setting.key + ".");
  });
  return found == idle.end() ? nullptr : &*found;
}

std::string SettingText(const std::string& yaml, const std::string& key) {
  return fmt::format("{}", fmt::join(Config::FromText(yaml, "").List(key), ", "));
}

// Whether two experiments, given as YAML of all effective keys, differ only in this key.
bool DifferInOnly(const std::string& key, const std::string& a, const std::string& b) {
  const std::vector<StatedKey> of_a = StatedKeys(Config::FromText(a, ""));
  const std::vector<StatedKey> of_b = StatedKeys(Config::FromText(b, ""));
  const auto alike = [&](const StatedKey& one, const StatedKey& other) {
    return one.key == other.key && (one.text == other.text) == (one.key != key);
  };
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), alike);
}

// Whether poses would drift with a drift_scale above 0.
bool WouldDrift(const SlamOptions& slam) {
  return slam.walk_translation_m > 0.0 || slam.walk_rotation_deg > 0.0 ||
         slam.drift_speed_mps > 0.0 || slam.drift_turn_dps > 0.0;
}

bool Jumps(const SlamOptions& slam) { return slam.jump_rate_hz > 0.0; }

bool IsEverLost(const SlamOptions& slam) { return slam.lost_rate_hz > 0.0; }

bool ClosesLoops(const SlamOptions& slam) { return slam.loops.recall > 0.0; }

bool HasBias(const SlamOptions& slam) {
  return slam.bias_translation_m > 0.0 || slam.bias_rotation_deg > 0.0;
}

// Jitter does not count, because it is not tilted.
bool TurnsBesideJitter(const SlamOptions& slam) {
  return slam.bias_rotation_deg > 0.0 || (Jumps(slam) && slam.jump_rotation_deg > 0.0) ||
         (IsEverLost(slam) && slam.relocalisation_rotation_deg > 0.0) ||
         (slam.drift_scale > 0.0 && (slam.walk_rotation_deg > 0.0 || slam.drift_turn_dps > 0.0));
}

void AddSlamLoops(const SlamLoopOptions& loops, IdleSettingList& idle) {
  if (loops.recall > 0.0) {
    if (loops.precision < 1.0) return;
    idle.push_back({"slam.loops.follow_false", Stands(loops, "slam.loops", "precision")});
    return;
  }
  const bool is_none = loops.scenario == LoopScenario::kNone;
  for (const std::string& key : KeyPathsOf(loops)) {
    if (key == "scenario" || key == "recall") continue;
    idle.push_back(
        {"slam.loops." + key, Stands(loops, "slam.loops", is_none ? "scenario" : "recall")});
  }
}

// `exact`: why all its poses are the true ones; empty if they are not.
void AddSlam(const SlamOptions& slam, const std::string& exact, IdleSettingList& idle) {
  const auto add = [&](std::initializer_list<const char*> keys, const std::string& reason) {
    for (const char* key : keys) {
      idle.push_back({std::string("slam.") + key, exact.empty() ? reason : exact});
    }
  };
  const auto stands = [&](const char* key) { return Stands(slam, "slam", key); };
  if (!WouldDrift(slam)) {
    add({"drift_scale"}, "SLAM does not drift");
  } else if (slam.drift_scale == 0.0) {
    // Not `exact`: the scale is the nearer reason.
    for (const char* key : {"walk_translation_m", "walk_rotation_deg", "drift_speed_mps",
                            "drift_turn_dps", "drift_time_s"}) {
      idle.push_back({std::string("slam.") + key, stands("drift_scale")});
    }
  }
  if (slam.drift_speed_mps == 0.0 && slam.drift_turn_dps == 0.0) {
    add({"drift_time_s"}, "slam.drift_speed_mps and slam.drift_turn_dps are 0");
  }
  if (!HasBias(slam)) {
    add({"bias_time_s"}, "slam.bias_translation_m and slam.bias_rotation_deg are 0");
  }
  if (!TurnsBesideJitter(slam)) {
    if (slam.jitter_rotation_deg == 0.0) add({"pivot_m"}, "SLAM's poses have no error of rotation");
    add({"tilt_share"}, "SLAM's poses have no error of rotation but jitter");
  }
  if (!Jumps(slam)) {
    for (const char* key : {"jump_translation_m", "jump_rotation_deg"}) {
      idle.push_back({std::string("slam.") + key, stands("jump_rate_hz")});
    }
  }
  if (!IsEverLost(slam)) {
    for (const char* key :
         {"lost_mean_s", "relocalisation_translation_m", "relocalisation_rotation_deg"}) {
      idle.push_back({std::string("slam.") + key, stands("lost_rate_hz")});
    }
  }
  AddSlamLoops(slam.loops, idle);
}

IsOneOfKeys KeysIn(const IdleSettingList& idle) {
  return [&idle](const std::string& key) { return Find(idle, key) != nullptr; };
}

// Sets presets and scales to their defaults: a preset's values are all present, and what a scale of
// 0 removes is idle.
SlamOptions WithoutPresets(SlamOptions slam) {
  const SlamOptions usual;
  slam.profile = usual.profile;
  if (!ClosesLoops(slam)) slam.loops.scenario = usual.loops.scenario;
  if (slam.drift_scale == 0.0) slam.drift_scale = usual.drift_scale;
  return slam;
}

// Why SLAM's errors are the same for every seed; empty where they are not.
std::string WhyExact(const SlamOptions& slam) {
  const SlamOptions truth = ProfileOptions(SlamProfile::kGroundTruth);
  IdleSettingList idle;
  AddSlam(slam, "", idle);
  const SlamOptions used = WithDefaults(WithoutPresets(slam), "slam", KeysIn(idle));
  if (ToYaml(used) != ToYaml(truth)) return "";
  return slam.profile == truth.profile ? Stands(slam, "slam", "profile")
                                       : "SLAM's poses are the true ones";
}

bool LimitIsSoft(const SensorOptions& sensor) {
  return sensor.grazing_softness_deg > 0.0 && sensor.grazing_limit_deg < kNoGrazingLimitDeg;
}

// The same for the depth images.
std::string WhyClean(const SensorOptions& sensor) {
  if (sensor.flying_pixels > 0.0) return "";
  if (sensor.noise == DepthNoiseModel::kNone) return Stands(sensor, "sensor", "noise");
  if (sensor.noise_scale > 0.0 || LimitIsSoft(sensor)) return "";
  return Stands(sensor, "sensor", "noise_scale");
}

bool HasFocalLengths(const SensorOptions& sensor) {
  return sensor.fx_px > 0.0 && sensor.fy_px > 0.0;
}

// Without a noise model only pixels at edges and in shadow change.
void AddSensor(const SensorOptions& sensor, IdleSettingList& idle) {
  if (HasFocalLengths(sensor)) {
    idle.push_back({"sensor.hfov_deg", "sensor.fx and sensor.fy are set"});
  }
  if (sensor.noise != DepthNoiseModel::kNone) {
    if (sensor.grazing_limit_deg >= kNoGrazingLimitDeg) {
      idle.push_back(
          {"sensor.grazing_softness_deg", Stands(sensor, "sensor", "grazing_limit_deg")});
    }
    if (sensor.noise_scale == 0.0) {
      idle.push_back({"sensor.noise_correlation_px", Stands(sensor, "sensor", "noise_scale")});
    }
    return;
  }
  for (const char* key :
       {"noise_scale", "noise_correlation_px", "grazing_limit_deg", "grazing_softness_deg"}) {
    idle.push_back({std::string("sensor.") + key, Stands(sensor, "sensor", "noise")});
  }
}

void AddSeeds(const ExperimentOptions& options, IdleSettingList& idle) {
  if (IsFileName(options.trajectory)) {
    idle.push_back({"trajectory_seed", "the path is a file's"});
  }
  const std::string exact = WhyExact(options.slam);
  const std::string clean = WhyClean(options.sensor);
  if (!exact.empty()) idle.push_back({"slam_seed", exact});
  if (!clean.empty()) idle.push_back({"depth_seed", clean});
  // The experiment's seed affects only these two.
  const std::string depth = options.depth_seed != 0 ? "depth_seed is set" : clean;
  const std::string slam = options.slam_seed != 0 ? "slam_seed is set" : exact;
  if (!depth.empty() && !slam.empty()) idle.push_back({"seed", depth + " and " + slam});
}

}  // namespace

IdleSettingList IdleSettings(const ExperimentOptions& options) {
  IdleSettingList idle = IdleSettings(options.mapper);
  AddSlam(options.slam, WhyExact(options.slam), idle);
  AddSensor(options.sensor, idle);
  AddSeeds(options, idle);
  idle.push_back({"mapper.scan.floor_z_m", "the scene's floor_z_m is taken"});
  if (!ClosesLoops(options.slam)) {
    for (const char* key : {"mapper.loops.use", "mapper.loops.verify"}) {
      idle.push_back({key, Stands(options.slam, "slam", "loops.recall")});
    }
  }
  if (!options.metrics.navigation) {
    idle.push_back({"metrics.navigability", Stands(options.metrics, "metrics", "navigation")});
  }
  return idle;
}

IdleSettingList IdleSettings(const SequenceOptions& options, SequenceFormat format,
                             const std::string& input_is, bool with_loops) {
  IdleSettingList idle;
  const std::string recording = "sequence.recording.";
  const auto add = [&](const std::string& key) { idle.push_back({key, input_is}); };
  if (format == SequenceFormat::kCarmen) {
    for (const char* key :
         {"sequence.camera", "sequence.camera_mount", "sequence.world_up", "mapper.scan"})
      add(key);
    for (const StatedKey& stated : StatedKeys(Config::FromText(ToYaml(RecordingOptions{}), ""))) {
      const bool is_used = with_loops && stated.key == "max_stamp_difference_s";
      if (!is_used) add(recording + stated.key);
    }
    return idle;
  }
  add("sequence.laser");
  if (format != SequenceFormat::kTum) add(recording + "pose_stamp");
  if (format != SequenceFormat::kFrames) add(recording + "frame_rate_hz");
  if (!options.recording.interpolate_poses) {
    idle.push_back({recording + "max_interpolation_gap_s",
                    Stands(options.recording, "sequence.recording", "interpolate_poses")});
  }
  return idle;
}

IdleSettingList InBoth(const IdleSettingList& a, const IdleSettingList& b) {
  IdleSettingList both;
  std::copy_if(a.begin(), a.end(), std::back_inserter(both),
               [&](const IdleSetting& setting) { return Find(b, setting.key) != nullptr; });
  return both;
}

ExperimentOptions WithoutIdleSettings(ExperimentOptions options) {
  const IdleSettingList idle = IdleSettings(options);
  const IsOneOfKeys is_idle = KeysIn(idle);
  const std::uint64_t slam_seed = is_idle("slam_seed") ? 0 : options.SlamSeed();
  const std::uint64_t depth_seed = is_idle("depth_seed") ? 0 : options.DepthSeed();
  options.slam = WithoutPresets(options.slam);
  ExperimentOptions used = WithDefaults(std::move(options), "", is_idle);
  used.slam_seed = slam_seed;
  used.depth_seed = depth_seed;
  used.seed = 0;  // it affects only the other two
  return used;
}

bool IsPreset(const std::string& key) {
  return std::find(kPresets.begin(), kPresets.end(), key) != kPresets.end();
}

std::string WhyPresetIsIdle(const std::string& key, const std::string& with,
                            const std::string& without) {
  return DifferInOnly(key, with, without) ? "all keys that it sets are given" : "";
}

std::vector<std::string> DoubtsOfOverrides(const std::vector<std::string>& set,
                                           const IdleSettingList& idle,
                                           const SettingsWith& settings_with) {
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < set.size(); ++i) {
    Config assignment;
    assignment.Set(set[i]);
    std::vector<std::string> others = set;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    for (const StatedKey& stated : StatedKeys(assignment)) {
      const IdleSetting* setting = Find(idle, stated.key);
      if (setting == nullptr && !IsPreset(stated.key)) continue;
      const std::string with = settings_with(set);
      const std::string without = settings_with(others);
      if (SettingText(with, stated.key) == SettingText(without, stated.key)) continue;
      const std::string reason =
          setting == nullptr ? WhyPresetIsIdle(stated.key, with, without) : setting->reason;
      if (reason.empty()) continue;
      const bool is_all = set[i].starts_with(stated.key + "=");
      doubts.push_back(fmt::format("--set {}: {}has no effect because {}", set[i],
                                   is_all ? "" : stated.key + " ", reason));
    }
  }
  return doubts;
}

std::vector<std::string> DoubtsOfFile(const Config& file, const IdleSettingList& idle,
                                      const std::function<ExperimentOptions()>& alone,
                                      const IsOverridden& is_overridden) {
  std::vector<StatedKey> stated = StatedKeys(file);
  std::erase_if(stated, [&](const StatedKey& key) {
    return Find(idle, key.key) == nullptr || is_overridden(key.key);
  });
  if (stated.empty() || file.Has("provenance")) return {};
  const ExperimentOptions own = alone();
  const IdleSettingList own_idle = IdleSettings(own);
  const std::string values = ToYaml(own);
  const std::string usual = ToYaml(ExperimentOptions{});
  std::vector<std::string> doubts;
  for (const auto& [key, place, text] : stated) {
    const IdleSetting* setting = Find(own_idle, key);
    if (setting == nullptr || SettingText(values, key) == SettingText(usual, key)) continue;
    doubts.push_back(fmt::format("{}: {} has no effect because {}", place, key, setting->reason));
  }
  return doubts;
}

}  // namespace depthgrid
