// Whether the room and the path that a run.yaml was written for are unchanged.
#pragma once

#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "mapper/io/config.h"

namespace depthgrid {

// What the user selects again, and so may be different.
struct ChosenAnew {
  bool scene = false;  // with its path, unless that is a file
  bool trajectory = false;
};

// One line for each of the two that has changed. `record`: `provenance` of the experiment at
// `path`, empty if it has none; then nothing is reported. `options`: the experiment as it will be
// run.
std::vector<std::string> DoubtsOfRecord(const std::string& path, const Config& record,
                                        const ExperimentOptions& options, const ChosenAnew& anew);

}  // namespace depthgrid
