// Reads the experiment named on the command line, with its overrides.
#pragma once

#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/experiment/experiment_options.h"
#include "mapper/io/config.h"

namespace depthgrid::cli {

// The settings of an experiment's file. Throws InputError for a scene, a mesh or a sweep.
Config ExperimentFile(const std::string& path);

// Whether `name` is an experiment rather than a scene or a mesh.
bool IsExperiment(const std::string& name);

// Warnings about settings that are probably not intended, one line each: settings of an experiment
// for its slam.profile, such as calibrated drift, when `set` selects another profile; settings in
// `set` or in a user's file without effect, such as a gain where it is learnt; a principal point
// outside the image or pixels that are not square; a scene or path that has changed since a
// run.yaml was written.
std::vector<std::string> DoubtsOfSettings(const std::string& name,
                                          const std::vector<std::string>& set);

// Only those that concern the images, and seeds without effect. `name` may also be a scene or a
// mesh.
std::vector<std::string> DoubtsOfImages(const std::string& name,
                                        const std::vector<std::string>& set);

// Only changes since a run.yaml was written; empty for a scene or a mesh.
std::vector<std::string> DoubtsOfRecord(const std::string& name,
                                        const std::vector<std::string>& set);

ExperimentOptions ExperimentNamed(const std::string& name, const std::vector<std::string>& set);

// Where a key of that experiment (or of ExperimentOrScene) was set; empty where it was not.
KeyPlaces PlacesOf(const std::string& name, const std::vector<std::string>& set);

// The experiment of that name, or the default experiment in the scene of that name (or scene or
// mesh file).
ExperimentOptions ExperimentOrScene(const std::string& name, const std::vector<std::string>& set);

// The files that these experiments, which come from `name`, are read from.
std::vector<std::string> InputsOf(const std::string& name,
                                  const std::vector<ExperimentOptions>& experiments);

// Throws InputError with the advice `instead` when one of the assignments sets the key.
void RequireNotSet(const std::vector<std::string>& set, const std::string& key,
                   const std::string& instead);

// The cache folder for rendered depth: --cache, else $DEPTHGRID_CACHE; none with --no-cache.
std::string CacheFolder(const CommonArguments& arguments);
// Throws InputError when the cache folder is the output folder or in it, because the output folder
// must be empty before the command writes to it.
void RequireCacheElsewhere(const CommonArguments& arguments);

}  // namespace depthgrid::cli
