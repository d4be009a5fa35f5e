// `depthgrid scenes SCENE`: facts about a scene for writing experiments.
#pragma once

#include "eval/cli/commands.h"

namespace depthgrid::cli {

// Prints size, floor, ceiling, paths and movers of one scene, and problems of paths; draws its plan
// if requested.
void ShowScene(const ScenesArguments& arguments);

}  // namespace depthgrid::cli
