#include "eval/idle_settings.h"

#include <fmt/format.h>

#include <algorithm>

namespace depthgrid {
namespace {

struct StatedKey {
  std::string key;
  std::string place;
};

// The single values of a tree, those in groups by their whole path.
void AddStated(const Config& config, const std::string& prefix, std::vector<StatedKey>& stated) {
  for (const ConfigEntry& entry : config.Entries()) {
    if (entry.map) {
      AddStated(*entry.map, prefix + entry.key + ".", stated);
    } else {
      stated.push_back({prefix + entry.key, entry.place});
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

// "GROUP.KEY is VALUE" of one of the options' own keys.
template <typename Options>
std::string Stands(const Options& options, const std::string& group, const std::string& key) {
  return fmt::format("{}.{} is {}", group, key, ValueOf(options, key));
}

bool Drifts(const SlamOptions& slam) {
  return slam.walk_translation_m > 0.0 || slam.walk_rotation_deg > 0.0 ||
         slam.drift_speed_mps > 0.0 || slam.drift_turn_dps > 0.0;
}

bool Jumps(const SlamOptions& slam) { return slam.jump_rate_hz > 0.0; }

bool IsEverLost(const SlamOptions& slam) { return slam.lost_rate_hz > 0.0; }

SlamOptions WithoutIdleSettings(SlamOptions slam) {
  const SlamOptions usual = ProfileOptions(SlamProfile::kGroundTruth);
  slam.profile = usual.profile;  // its values are all there
  if (!Drifts(slam)) slam.drift_scale = usual.drift_scale;
  if (!Jumps(slam)) {
    slam.jump_translation_m = usual.jump_translation_m;
    slam.jump_rotation_deg = usual.jump_rotation_deg;
  }
  if (!IsEverLost(slam)) {
    slam.lost_mean_s = usual.lost_mean_s;
    slam.relocalisation_translation_m = usual.relocalisation_translation_m;
    slam.relocalisation_rotation_deg = usual.relocalisation_rotation_deg;
  }
  return slam;
}

// Why SLAM's errors are the same for every seed; empty where they are not.
std::string WhyExact(const SlamOptions& slam) {
  const SlamOptions truth = ProfileOptions(SlamProfile::kGroundTruth);
  if (ToYaml(WithoutIdleSettings(slam)) != ToYaml(truth)) return "";
  return slam.profile == truth.profile ? Stands(slam, "slam", "profile")
                                       : "SLAM's poses are the true ones";
}

// The same of the depth images.
std::string WhyClean(const SensorOptions& sensor) {
  const bool noisy = sensor.noise != DepthNoiseModel::kNone || sensor.flying_pixels > 0.0;
  return noisy ? "" : Stands(sensor, "sensor", "noise");
}

void AddSlam(const SlamOptions& slam, IdleSettingList& idle) {
  const auto add = [&](std::initializer_list<const char*> keys, const std::string& reason) {
    for (const char* key : keys) idle.push_back({std::string("slam.") + key, reason});
  };
  if (!Drifts(slam)) {
    const std::string exact = WhyExact(slam);
    add({"drift_scale"}, exact.empty() ? "SLAM does not drift" : exact);
  }
  if (!Jumps(slam)) {
    add({"jump_translation_m", "jump_rotation_deg"}, Stands(slam, "slam", "jump_rate_hz"));
  }
  if (!IsEverLost(slam)) {
    add({"lost_mean_s", "relocalisation_translation_m", "relocalisation_rotation_deg"},
        Stands(slam, "slam", "lost_rate_hz"));
  }
}

bool HasFocalLengths(const SensorOptions& sensor) {
  return sensor.fx_px > 0.0 && sensor.fy_px > 0.0;
}

// Without a model only the pixels at edges and in shadow change.
void AddSensor(const SensorOptions& sensor, IdleSettingList& idle) {
  if (HasFocalLengths(sensor)) {
    idle.push_back({"sensor.hfov_deg", "sensor.fx and sensor.fy are set"});
  }
  if (sensor.noise != DepthNoiseModel::kNone) return;
  for (const char* key :
       {"noise_scale", "noise_correlation_px", "grazing_limit_deg", "grazing_softness_deg"}) {
    idle.push_back({std::string("sensor.") + key, Stands(sensor, "sensor", "noise")});
  }
}

SensorOptions WithoutIdleSettings(SensorOptions sensor) {
  const SensorOptions usual;
  if (HasFocalLengths(sensor)) sensor.hfov_deg = usual.hfov_deg;
  if (sensor.noise != DepthNoiseModel::kNone) return sensor;
  sensor.noise_scale = usual.noise_scale;
  sensor.noise_correlation_px = usual.noise_correlation_px;
  sensor.grazing_limit_deg = usual.grazing_limit_deg;
  sensor.grazing_softness_deg = usual.grazing_softness_deg;
  return sensor;
}

// What the profile is taken for, all but the choice itself.
void AddSlamNoise(const FusionOptions& fusion, IdleSettingList& idle) {
  if (fusion.slam_noise.source != SlamNoiseSource::kProfile) return;
  const std::string group = "mapper.fusion.slam_noise";
  for (const std::string& key : KeyPathsOf(fusion.slam_noise)) {
    if (key == "source") continue;
    idle.push_back({group + "." + key, Stands(fusion.slam_noise, group, "source")});
  }
}

void AddSeeds(const ExperimentOptions& options, IdleSettingList& idle) {
  const std::string exact = WhyExact(options.slam);
  const std::string clean = WhyClean(options.sensor);
  if (!exact.empty()) idle.push_back({"slam_seed", exact});
  if (!clean.empty()) idle.push_back({"depth_seed", clean});
  // The two are all that the experiment's own is for.
  const std::string depth = options.depth_seed != 0 ? "depth_seed is set" : clean;
  const std::string slam = options.slam_seed != 0 ? "slam_seed is set" : exact;
  if (!depth.empty() && !slam.empty()) idle.push_back({"seed", depth + " and " + slam});
}

// What only the other method reads. (The report's pictures are of submaps with either.)
void AddOtherMethod(const MapperOptions& mapper, IdleSettingList& idle) {
  const std::string chosen = Stands(mapper, "mapper", "method");
  const bool is_surfel = mapper.method == MapperMethod::kSurfel;
  idle.push_back({is_surfel ? "mapper.match" : "mapper.surfel", chosen});
  idle.push_back({is_surfel ? "mapper.graph" : "mapper.rounds", chosen});
}

MapperOptions WithoutOtherMethod(MapperOptions mapper) {
  const MapperOptions usual;
  if (mapper.method == MapperMethod::kSurfel) {
    mapper.match = usual.match;
    mapper.graph = usual.graph;
  } else {
    mapper.surfel = usual.surfel;
    mapper.rounds = usual.rounds;
  }
  return mapper;
}

}  // namespace

IdleSettingList IdleSettings(const MapperOptions& mapper) {
  const FusionOptions& fusion = mapper.fusion;
  IdleSettingList idle;
  AddOtherMethod(mapper, idle);
  const auto add = [&](const char* key) {
    idle.push_back({key, Stands(fusion, "mapper.fusion", "mode")});
  };
  if (fusion.mode != FusionMode::kFixed && fusion.mode != FusionMode::kAdaptive) {
    add("mapper.fusion.gain");
  }
  if (fusion.mode != FusionMode::kAdaptive) add("mapper.fusion.adaptive_rate");
  if (fusion.mode != FusionMode::kLearned) {
    for (const char* key : {"mapper.fusion.judge_innovations", "mapper.rounds.again"}) add(key);
  }
  AddSlamNoise(fusion, idle);
  if (mapper.scan.mode != ScanMode::kRowBand) {
    idle.push_back({"mapper.scan.band_rows", Stands(mapper.scan, "mapper.scan", "mode")});
  }
  return idle;
}

IdleSettingList IdleSettings(const ExperimentOptions& options) {
  IdleSettingList idle = IdleSettings(options.mapper);
  AddSlam(options.slam, idle);
  AddSensor(options.sensor, idle);
  AddSeeds(options, idle);
  idle.push_back({"mapper.scan.floor_z_m", "the scene's floor_z_m is taken"});
  return idle;
}

IdleSettingList IdleSettings(const SequenceOptions& options, SequenceFormat format,
                             const std::string& input_is, bool with_loops) {
  IdleSettingList idle;
  const std::string recording = "sequence.recording.";
  const auto add = [&](const std::string& key) { idle.push_back({key, input_is}); };
  if (format == SequenceFormat::kCarmen) {
    for (const char* key : {"sequence.camera", "sequence.world_up", "mapper.scan"}) add(key);
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
  const auto is_idle = [&](const char* key) { return Find(idle, key) != nullptr; };
  options.slam_seed = is_idle("slam_seed") ? 0 : options.SlamSeed();
  options.depth_seed = is_idle("depth_seed") ? 0 : options.DepthSeed();
  options.seed = 0;  // the two are all it is for
  options.slam = WithoutIdleSettings(options.slam);
  options.sensor = WithoutIdleSettings(options.sensor);
  options.mapper = WithoutOtherMethod(options.mapper);
  if (is_idle("mapper.scan.band_rows")) {
    options.mapper.scan.band_rows = MapperOptions{}.scan.band_rows;
  }
  options.mapper.scan.floor_z_m = MapperOptions{}.scan.floor_z_m;
  FusionOptions& fusion = options.mapper.fusion;
  if (const auto source = fusion.slam_noise.source; source == SlamNoiseSource::kProfile) {
    fusion.slam_noise = {};
    fusion.slam_noise.source = source;
  }
  if (is_idle("mapper.fusion.gain")) fusion.gain = FusionOptions{}.gain;
  if (is_idle("mapper.fusion.adaptive_rate")) {
    fusion.adaptive_rate = FusionOptions{}.adaptive_rate;
  }
  if (is_idle("mapper.fusion.judge_innovations")) {
    fusion.judge_innovations = FusionOptions{}.judge_innovations;
  }
  if (is_idle("mapper.rounds.again")) {
    options.mapper.rounds.again = RoundOptions{}.again;
  }
  return options;
}

std::vector<std::string> DoubtsOfOverrides(const std::vector<std::string>& set,
                                           const IdleSettingList& idle,
                                           const SettingsWith& settings_with) {
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < set.size(); ++i) {
    Config assignment;
    assignment.Set(set[i]);
    for (const StatedKey& stated : StatedKeys(assignment)) {
      const IdleSetting* setting = Find(idle, stated.key);
      if (setting == nullptr) continue;
      std::vector<std::string> others = set;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      if (SettingText(settings_with(set), stated.key) ==
          SettingText(settings_with(others), stated.key)) {
        continue;
      }
      const bool is_all = set[i].starts_with(stated.key + "=");
      doubts.push_back(fmt::format("--set {}: {}has no effect because {}", set[i],
                                   is_all ? "" : stated.key + " ", setting->reason));
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
  for (const auto& [key, place] : stated) {
    const IdleSetting* setting = Find(own_idle, key);
    if (setting == nullptr || SettingText(values, key) == SettingText(usual, key)) continue;
    doubts.push_back(fmt::format("{}: {} has no effect because {}", place, key, setting->reason));
  }
  return doubts;
}

}  // namespace depthgrid
