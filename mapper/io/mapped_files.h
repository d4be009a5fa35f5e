// A map to go on in, as files of a folder: scans.bin holds what it is drawn from and, where that is
// another scan, matched.bin what is matched. A folder of `depthgrid run` or `map` is one.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/mapped_frame.h"

namespace depthgrid {

// `mapped` of a MapperResult, or CurrentMapped(), into a folder that is there, in place of what was
// saved there before. A save that is cut off leaves a map: that one or this. Throws
// std::runtime_error where nothing can be written.
void WriteMapped(const std::string& folder, const std::vector<MappedFrame>& frames);

// The frames as PriorMap wants them: their numbers are below 0, one left out between two drives.
// Throws InputError for files that are missing, damaged, empty or of two maps.
std::vector<MappedFrame> ReadMapped(const std::string& folder);

}  // namespace depthgrid
