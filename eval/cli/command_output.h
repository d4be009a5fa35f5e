// The folder of a command's result.
#pragma once

#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/output/output_folder.h"
#include "eval/output/result_files.h"

namespace depthgrid::cli {

// The folder for a result of this kind; what an earlier one left there goes. `inputs`: files and
// folders that the command reads; `cases`: those of a study. Throws InputError, before anything is
// done, for what OutputFolder does not take, for a folder of another result or of names that it
// cannot have, and when an input would be overwritten or removed.
OutputFolder OpenOutput(const CommonArguments& arguments, ResultKind kind,
                        const std::vector<std::string>& inputs,
                        const std::vector<std::string>& cases = {});

}  // namespace depthgrid::cli
