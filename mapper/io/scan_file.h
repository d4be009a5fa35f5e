// scans.bin: the scans a map was drawn from, at their final poses, so that it can be drawn again
// (docs/run_folder.md, "scans.bin"). Little-endian, no padding.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/kept_scan.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

struct StoredScan {
  int frame = 0;  // of the input, counted from 0; below 0: of a map that was gone on in
  double stamp_s = 0.0;
  Pose2 map_from_base;
  KeptScan scan;

  bool operator==(const StoredScan&) const = default;
};

// Throws InputError for a file that is missing, truncated or something else.
std::vector<StoredScan> ReadScans(const std::string& path);
// Beams must be such that CanBeKept(), as a mapper's are: others are not read again.
void WriteScans(const std::string& path, const std::vector<StoredScan>& scans);

}  // namespace depthgrid
