// The settings of a run that are not the program's defaults, wherever they were set: what a reader
// of its page would otherwise look for among hundreds of keys.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "mapper/io/config.h"

namespace depthgrid {

// "mapper.grid.resolution_m 0.02" of a run.yaml, in its order. Left out: names of files, what a
// page's first line says, and what follows from the scene or the profile. Defaults of `slam` are
// those of its profile. Keys of other versions are no matter.
std::vector<std::string> ChangedSettings(const Config& run_yaml);

// A key, with its value in each of several runs.
struct DifferingSetting {
  std::string key;
  std::vector<std::string> values;
};

// Of these runs' files, in the order of the first: what is not the same in all. Left out: the
// scene, SLAM's settings, and what follows from either.
std::vector<DifferingSetting> DifferingSettings(const std::vector<Config>& run_yamls);

// The name of SLAM's profile; "own settings over ground_truth" where others make true poses err, as
// fitted ones do (slam-fit). Empty for recorded poses.
std::string PoseSourceOf(const Config& run_yaml);

// What a page's first line says: ", trajectory handheld, SLAM orb_slam2, ...", of what there is.
std::string MainSettings(const Config& run_yaml);

// What runs of one experiment measure, the keys that they differ in left out: "living_room, 240
// frames, trajectory handheld, ...".
std::string MeasuredSettings(const Config& experiment, const std::set<std::string>& varied);

}  // namespace depthgrid
