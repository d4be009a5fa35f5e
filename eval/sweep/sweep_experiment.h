// The experiment that a sweep repeats, and the sweep's changes to it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "eval/sweep/sweep_axes.h"
#include "mapper/io/config.h"

namespace depthgrid {

struct ExperimentFile {
  std::string path;
  std::string folder;  // to which its file names are relative
  Config config;
  Config record;  // `provenance`, of a run.yaml
};

// `place`: where the sweep's file names it, for errors. Throws InputError.
ExperimentFile ReadExperimentFile(const std::string& name, const std::string& place,
                                  const std::string& sweep_folder);

// Applies what the sweep's file sets in all runs, then --set.
Config Changed(Config config, const Config& fixed, const std::vector<std::string>& set);

// The place of each key that is given: on an axis, else in `changes`, else in the experiment.
std::map<std::string, std::string> PlacesOf(const Config& experiment, const Config& changes,
                                            const std::vector<SweepAxis>& axes);

// The lines of SweepPlan::given_text: the `effective` values of those keys below `prefix` that
// `base` has.
std::string GivenText(const Config& effective, const Config& base, const std::string& prefix = "");

}  // namespace depthgrid
