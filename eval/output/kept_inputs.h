// Protects a command's inputs from being overwritten by its output.
#pragma once

#include <string>
#include <vector>

#include "eval/output/result_files.h"

namespace depthgrid {

// Throws InputError when the file `output`, which `option` names, is one of `inputs`.
void RequireInputsKept(const std::string& output, const std::string& option,
                       const std::vector<std::string>& inputs);

// Throws InputError when one of `inputs`, or of the files of a folder among them, is in the folder
// `output` and would be written or removed.
void RequireInputsKept(const std::string& output, const FileRule& is_changed,
                       const std::vector<std::string>& inputs);

}  // namespace depthgrid
