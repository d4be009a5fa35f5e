// What a COLLADA file says of its own size, held against the file: assimp makes room for as many
// items as it says and reads as far as it says, whatever is there.
#pragma once

#include <string>

namespace depthgrid {

// Throws InputError, with file and line, for a count, stride or offset that the file cannot hold,
// for an accessor that leads beyond its array and for what is no index in a list of them.
void RequireSoundCounts(const std::string& dae_path);

}  // namespace depthgrid
