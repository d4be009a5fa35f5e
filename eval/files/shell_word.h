// Quoting for shell commands that the program prints or gives to Slurm.
#pragma once

#include <string>

namespace depthgrid {

// `text` as one shell word, quoted if necessary.
std::string ShellWord(const std::string& text);

}  // namespace depthgrid
