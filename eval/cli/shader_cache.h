// The location of Mesa's shader cache.
#pragma once

#include "eval/cli/commands.h"

namespace depthgrid::cli {

// By default Mesa caches compiled shaders in the user's home. This puts them into the cache folder,
// or disables the cache if there is none or its disk is full. The user's own settings for Mesa are
// respected. Call it before any colour rendering and before other threads start.
void KeepShadersInCache(const CommonArguments& arguments);

}  // namespace depthgrid::cli
