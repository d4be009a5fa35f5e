// Opens the output folder of a command.
#pragma once

#include <string>
#include <vector>

#include "eval/cli/commands.h"
#include "eval/output/output_folder.h"
#include "eval/output/result_files.h"

namespace depthgrid::cli {

// Opens the folder for a result of this kind; an earlier result in it is replaced. `inputs`: files
// and folders that the command reads; `cases`: those of a study. Throws InputError, before any
// work, for what OutputFolder rejects, for a folder with another result or with conflicting names,
// and when an input would be overwritten or removed.
OutputFolder OpenOutput(const CommonArguments& arguments, ResultKind kind,
                        const std::vector<std::string>& inputs,
                        const std::vector<std::string>& cases = {});

}  // namespace depthgrid::cli
