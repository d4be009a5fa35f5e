// Names in commands that a shell reads: those the program shows and those it gives to Slurm.
#pragma once

#include <string>

namespace depthgrid {

// `text` as one word of a shell, in quotes if need be.
std::string ShellWord(const std::string& text);

}  // namespace depthgrid
