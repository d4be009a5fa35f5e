// Whether the room and the path that a run.yaml was written of are still the same.
#pragma once

#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "mapper/io/config.h"

namespace depthgrid {

// What is chosen anew, and so may be another one.
struct ChosenAnew {
  bool scene = false;  // with its path, but for one of a file
  bool trajectory = false;
};

// A line for each of the two that has changed since. `record`: `provenance` of the experiment at
// `path`, of which nothing is said where it has none; `options`: it as it is to be done.
std::vector<std::string> DoubtsOfRecord(const std::string& path, const Config& record,
                                        const ExperimentOptions& options, const ChosenAnew& anew);

}  // namespace depthgrid
