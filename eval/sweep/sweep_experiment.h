// The experiment that a sweep runs many times over, and what the sweep changes of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "eval/sweep/sweep_axes.h"
#include "mapper/io/config.h"

namespace depthgrid {

struct ExperimentFile {
  std::string path;
  std::string folder;  // where its file names start
  Config config;
  Config record;  // `provenance`, of a run.yaml
};

// `place`: where the sweep names it. Throws InputError.
ExperimentFile ReadExperimentFile(const std::string& name, const std::string& place,
                                  const std::string& sweep_folder);

// With what the sweep's file sets in all runs, and --set after it.
Config Changed(Config config, const Config& fixed, const std::vector<std::string>& set);

// Where each key that is given stands: on an axis, else in `changes`, else in the experiment.
std::map<std::string, std::string> PlacesOf(const Config& experiment, const Config& changes,
                                            const std::vector<SweepAxis>& axes);

// The lines of SweepPlan::given_text: of the `effective` keys below `prefix` those that `base` has.
std::string GivenText(const Config& effective, const Config& base, const std::string& prefix = "");

}  // namespace depthgrid
