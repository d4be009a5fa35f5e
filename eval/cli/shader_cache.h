// Where Mesa keeps the shaders that it compiled.
#pragma once

#include "eval/cli/commands.h"

namespace depthgrid::cli {

// Mesa keeps compiled shaders, in the user's home unless it is told where: in the cache folder, and
// not at all without one, or where its disk has no room for them. What the user told Mesa stands.
// Before anything is drawn in colour, and before other threads begin.
void KeepShadersInCache(const CommonArguments& arguments);

}  // namespace depthgrid::cli
