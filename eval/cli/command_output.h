// The folder of a command's result.
#pragma once

#include "eval/cli/commands.h"
#include "eval/output_folder.h"

namespace depthgrid::cli {

// Throws InputError for what OutputFolder does not take, and for a sweep's folder: its page and
// table would be mixed with the result.
OutputFolder OpenOutput(const CommonArguments& arguments);

}  // namespace depthgrid::cli
