// The settings of a run that differ from the program's defaults, for its page: otherwise they are
// hard to find among hundreds of keys.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "mapper/io/config.h"

namespace depthgrid {

// "mapper.grid.resolution_m 0.02" of a run.yaml, in its order. Left out are file names, settings in
// the page's first line, and those that follow from the scene or the profile. Defaults of `slam`
// are those of its profile. Keys of other versions are ignored.
std::vector<std::string> ChangedSettings(const Config& run_yaml);

// A key, with its value in each of several runs.
struct DifferingSetting {
  std::string key;
  std::vector<std::string> values;
};

// The settings that differ in effect between these runs, in the order of the first file. Left out
// are the scene, SLAM's settings, and what follows from either.
std::vector<DifferingSetting> DifferingSettings(const std::vector<Config>& run_yamls);

// The name of SLAM's profile; "own settings over ground_truth" where other settings add errors to
// true poses, as fitted ones do (slam-fit). Empty for recorded poses.
std::string PoseSourceOf(const Config& run_yaml);

// The settings for a page's first line, as far as given: ", trajectory handheld, SLAM orb_slam2,
// ...".
std::string MainSettings(const Config& run_yaml);

// The settings common to runs of one experiment, without the varied keys: "living_room, 240 frames,
// trajectory handheld, ...". `scene_name`: the scene's own name; if empty, its file's.
std::string MeasuredSettings(const Config& experiment, const std::set<std::string>& varied,
                             const std::string& scene_name);

}  // namespace depthgrid
