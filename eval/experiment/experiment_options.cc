#include "eval/experiment/experiment_options.h"

#include <algorithm>
#include <filesystem>

#include "eval/experiment/shipped.h"
#include "mapper/core/error.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// Makes file names absolute, so that run.yaml is valid from any folder; names of shipped files are
// kept.
void ResolveFile(std::string& name, const std::string& base_folder) {
  if (IsFileName(name))
    name = fs::weakly_canonical(fs::absolute(fs::path(base_folder) / name)).string();
}

// The message for any other unknown key would name the one nearest to it.
void RefuseRecordings(const Config& config) {
  if (!config.Has("sequence")) return;
  throw InputError(
      config.PlaceOfKey("sequence"),
      "'sequence' holds how a recording is read, for `depthgrid map`; the images of an "
      "experiment are rendered");
}

}  // namespace

void ExperimentOptions::Visit(OptionsVisitor& v) {
  constexpr double kMaxFrames = 1e6;
  v.Text("scene", scene, "a shipped scene, a scene file or a mesh file");
  v.Text("trajectory", trajectory,
         "a trajectory that the scene names, or a TUM file; empty: the scene's first");
  v.Text("movers", movers,
         "which of the scene's movers are there: none, all, or names joined by +");
  v.Number("frames", frames, {0, kMaxFrames}, "number of frames; 0: as many as the path needs");
  v.Seed("seed", seed, "seed of the depth noise and of SLAM's errors");
  v.Seed("depth_seed", depth_seed, "seed of the depth noise alone; 0: that of key seed");
  v.Seed("slam_seed", slam_seed, "seed of SLAM's errors alone; 0: that of key seed");
  v.Seed("trajectory_seed", trajectory_seed, "seed of the shake of a hand-held camera");
  v.Group("sensor", sensor, "the depth camera");
  v.Group("slam", slam, "the SLAM system");
  v.Group("mapper", mapper, "the mapper");
  v.Group("metrics", metrics, "the scores of the map");
}

ExperimentOptions ReadExperiment(const std::vector<const Config*>& layers,
                                 const std::string& base_folder) {
  Require(!layers.empty(), "an experiment is read from something");
  ExperimentOptions options;
  for (const Config* layer : layers) {
    RefuseRecordings(*layer);
    layer->Read(options);
  }
  if (options.scene.empty()) throw InputError(layers.front()->Place(), "key 'scene' is missing");
  ResolveFile(options.scene, base_folder);
  ResolveFile(options.trajectory, base_folder);
  ResolveNameAt(PlaceOfKey(layers, "scene"), options.scene, ShippedKind::kScene);
  options.trajectory_place = PlaceOfKey(layers, "trajectory");
  return options;
}

void RequireSound(const ExperimentOptions& options, const std::vector<const Config*>& layers) {
  RequireSound(options, [&](const std::string& key) { return PlaceOfKey(layers, key); });
}

void RequireSound(const ExperimentOptions& options, const KeyPlaces& places) {
  RequireInRange(options, "", places);
  const std::string place = places("sensor");
  SensorCamera(options.sensor, place.empty() ? "sensor" : place + ": sensor");
}

ExperimentOptions ReadExperiment(Config config, const std::string& base_folder) {
  config.Take("provenance");  // a run.yaml may be run again
  if (config.Has("cases")) {
    throw InputError(config.Place(), "holds several experiments; only `depthgrid run` takes it");
  }
  ExperimentOptions options = ReadExperiment({&config}, base_folder);
  RequireSound(options, {&config});
  return options;
}

std::vector<std::string> KeptBesideProfile(Config file, const Config& changes,
                                           const std::vector<std::string>& profiles) {
  if (!file.Has("slam.profile")) return {};
  const std::string own = file.Text("slam.profile");
  const bool another = std::any_of(
      profiles.begin(), profiles.end(),
      [&](const std::string& profile) { return profile != own && profile != "ground_truth"; });
  if (!another) return {};
  std::vector<std::string> kept;
  for (const std::string& key : file.Take("slam").Keys()) {
    const std::string path = "slam." + key;
    if (key != "profile" && !changes.Has(path)) kept.push_back(path);
  }
  return kept;
}

}  // namespace depthgrid
