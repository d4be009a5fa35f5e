// `depthgrid scenes SCENE`: what there is to know before an experiment names it.
#pragma once

#include "eval/cli/commands.h"

namespace depthgrid::cli {

// Size, floor, ceiling, paths and movers of one scene, with what is wrong with a path; its plan if
// asked.
void ShowScene(const ScenesArguments& arguments);

}  // namespace depthgrid::cli
