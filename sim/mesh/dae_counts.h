// Checks the counts stated in a COLLADA file against its size: assimp allocates and reads as many
// items as stated without checking.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError, with file and line, for a count, stride or offset too large for the file, for
// an accessor that reads beyond its array, and for an invalid word in a list of indices.
void RequireSoundCounts(const std::string& dae_path);

}  // namespace depthgrid
