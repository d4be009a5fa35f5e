// Everything that decides what an experiment gives. What only decides how fast (threads, cache) is
// not here.
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
  // One the scene names, or a TUM file. Empty is the scene's only one, or its first by name.
  std::string trajectory;
  // Which of the scene's movers are there: `none`, `all`, or names joined by a plus sign.
  std::string movers = kNoMovers;
  // 0: as many as the path needs within its speed bounds, or all of the file. Fewer walk only the
  // path's beginning, more walk it slower.
  int frames = 0;
  std::uint64_t seed = 1;  // of depth noise and SLAM's errors
  // 0 follows `seed`; anything else holds one of the two still while the other varies.
  std::uint64_t depth_seed = 0;
  std::uint64_t slam_seed = 0;
  // Of the hand's shake. Apart from `seed`, so that runs over seeds see the same clean images.
  std::uint64_t trajectory_seed = 1;
  SensorOptions sensor;
  SlamOptions slam;
  MapperOptions mapper;
  MetricsOptions metrics;  // which scores; never changes the map
  // File and line (or the assignment) that names the trajectory, for errors of whoever loads the
  // scene; empty where nothing does.
  std::string trajectory_place;

  std::uint64_t DepthSeed() const { return depth_seed != 0 ? depth_seed : seed; }
  std::uint64_t SlamSeed() const { return slam_seed != 0 ? slam_seed : seed; }
  void Visit(OptionsVisitor& v);
};

// Reads an experiment and resolves its file names: those in `config` are relative to
// `base_folder`. Of several layers the later override the earlier. Throws InputError, also for a
// scene that is not there.
ExperimentOptions ReadExperiment(const std::vector<const Config*>& layers,
                                 const std::string& base_folder);
// Also throws what RequireSound does.
ExperimentOptions ReadExperiment(Config config, const std::string& base_folder);

// Throws InputError, with the place in `layers`, for values that only together make no sense. Not
// asked of a sweep's points: one that makes none is a failed run among others.
void RequireSound(const ExperimentOptions& options, const std::vector<const Config*>& layers);
void RequireSound(const ExperimentOptions& options, const KeyPlaces& places);

// The keys that an experiment's file sets beside slam.profile, such as the drift calibrated for it,
// and that stay when one of `profiles` is chosen in place of its own: those that `changes` does not
// set. Empty where nothing is amiss.
std::vector<std::string> KeptBesideProfile(Config file, const Config& changes,
                                           const std::vector<std::string>& profiles);

}  // namespace depthgrid
