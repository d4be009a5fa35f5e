// A map to continue, as files of a folder: scans.bin has the scans it is drawn from and
// matched.bin, if they differ, those that are matched. Folders of `depthgrid run` and `map` have
// this form.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/mapped_frame.h"

namespace depthgrid {

// Writes `mapped` of a MapperResult, or CurrentMapped(), into an existing folder, replacing an
// earlier map. A save that is killed, at any step, leaves either the old or the new map; so does a
// power cut. Throws std::runtime_error on a write error, DiskFullError where there is no room
// (mapper/io/file.h); the earlier map is there then, and nothing of the new one. Beside the files
// of the earlier map there must be room for those of the new.
void WriteMapped(const std::string& folder, const std::vector<MappedFrame>& frames);

// The frames as PriorMap needs them: with negative numbers, one skipped between two drives. Throws
// InputError for files that are missing, damaged, empty or of two maps.
std::vector<MappedFrame> ReadMapped(const std::string& folder);

// The file of the folder that ReadMapped() takes the matched scans from: matched.bin, or
// matched.next.bin after a save that was killed; empty if there is none.
std::string MatchedFileOf(const std::string& folder);

}  // namespace depthgrid
