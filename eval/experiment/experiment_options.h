// All options that affect an experiment's result. Those that affect only its speed (threads, cache)
// are not included.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eval/metrics/map_quality.h"
#include "mapper/io/config.h"
#include "mapper/mapper_options.h"
#include "sim/depth/sensor_options.h"
#include "sim/scene/mover.h"
#include "sim/slam/slam_options.h"

namespace depthgrid {

struct ExperimentOptions {
  std::string scene;  // a shipped scene, a scene file or a mesh file
  // A trajectory of the scene, or a TUM file. Empty: the scene's only one, or its first by name.
  std::string trajectory;
  // Which of the scene's movers are present: `none`, `all`, or names joined by a plus sign.
  std::string movers = kNoMovers;
  // 0: as many as the path needs within its speed limits, or all of the file. With fewer only the
  // beginning of the path is used, with more the camera moves slower.
  int frames = 0;
  std::uint64_t seed = 1;  // of depth noise and SLAM's errors
  // 0: same as `seed`. Other values fix one of the two while the other varies.
  std::uint64_t depth_seed = 0;
  std::uint64_t slam_seed = 0;
  // Of the hand's shake. Independent of `seed`, so that runs with different seeds have the same
  // noise-free images.
  std::uint64_t trajectory_seed = 1;
  SensorOptions sensor;
  SlamOptions slam;
  MapperOptions mapper;
  MetricsOptions metrics;  // which scores are computed; does not affect the map
  // File and line (or the assignment) that names the trajectory, for errors while loading the
  // scene; empty if nothing does.
  std::string trajectory_place;

  std::uint64_t DepthSeed() const { return depth_seed != 0 ? depth_seed : seed; }
  std::uint64_t SlamSeed() const { return slam_seed != 0 ? slam_seed : seed; }
  void Visit(OptionsVisitor& v);
};

// Reads an experiment and resolves its file names: those in `config` are relative to `base_folder`.
// Later layers override earlier ones. Throws InputError, also for a scene that is not there.
ExperimentOptions ReadExperiment(const std::vector<const Config*>& layers,
                                 const std::string& base_folder);
// Also throws what RequireSound does.
ExperimentOptions ReadExperiment(Config config, const std::string& base_folder);

// Throws InputError, with the place in `layers`, for values that contradict each other. Not called
// for a sweep's points, where a contradiction is a failed run.
void RequireSound(const ExperimentOptions& options, const std::vector<const Config*>& layers);
void RequireSound(const ExperimentOptions& options, const KeyPlaces& places);

// The keys that an experiment's file sets for its slam.profile, such as calibrated drift, and that
// remain when one of `profiles` is selected instead, because `changes` does not set them. Empty if
// there are none.
std::vector<std::string> KeptBesideProfile(Config file, const Config& changes,
                                           const std::vector<std::string>& profiles);

}  // namespace depthgrid
