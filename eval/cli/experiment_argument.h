// An experiment as named on the command line, with its overrides.
#pragma once

#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/experiment/experiment_options.h"
#include "mapper/io/config.h"

namespace depthgrid::cli {

// The file's settings; throws InputError for a scene or a mesh, which an experiment only names, and
// for a sweep.
Config ExperimentFile(const std::string& path);

// Of a name that may be that of a scene or a mesh: whether it is that of an experiment.
bool IsExperiment(const std::string& name);

// What is likely not meant, a line each: what an experiment sets beside slam.profile, such as the
// drift calibrated for it, when `set` chooses another profile; what of `set` and of a file of the
// user's has no effect, such as a gain where it is learnt; a camera whose principal point lies
// beside its images, or whose pixels are not square; and that a scene or path has changed since a
// run.yaml was written.
std::vector<std::string> DoubtsOfSettings(const std::string& name,
                                          const std::vector<std::string>& set);

// Of these what concerns the images, and seeds of what never varies, also where `name` is that of a
// scene or a mesh.
std::vector<std::string> DoubtsOfImages(const std::string& name,
                                        const std::vector<std::string>& set);

// Of these the last alone; nothing of a scene or a mesh.
std::vector<std::string> DoubtsOfRecord(const std::string& name,
                                        const std::vector<std::string>& set);

ExperimentOptions ExperimentNamed(const std::string& name, const std::vector<std::string>& set);

// Where a key of that experiment, or of a scene by itself, was set; empty where it was not.
KeyPlaces PlacesOf(const std::string& name, const std::vector<std::string>& set);

// The experiment of that name, or else everything at its default in the scene of that name (or
// scene or mesh file).
ExperimentOptions ExperimentOrScene(const std::string& name, const std::vector<std::string>& set);

// The files that these experiments, which are of this file or shipped name, are read from.
std::vector<std::string> InputsOf(const std::string& name,
                                  const std::vector<ExperimentOptions>& experiments);

// Throws InputError, which says `instead`, when one of the assignments sets the key.
void RequireNotSet(const std::vector<std::string>& set, const std::string& key,
                   const std::string& instead);

// Where rendered depth is kept: --cache, or else $DEPTHGRID_CACHE, unless --no-cache.
std::string CacheFolder(const CommonArguments& arguments);
// Throws InputError when it is the output folder or lies in it: that is empty, or another's, before
// anything is written there.
void RequireCacheElsewhere(const CommonArguments& arguments);

}  // namespace depthgrid::cli
