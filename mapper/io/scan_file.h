// scans.bin: the scans a map was drawn from, at their final poses, so that it can be drawn again
// (docs/run_folder.md, "scans.bin"). Little-endian, no padding.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/kept_scan.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

struct StoredScan {
  int frame = 0;  // input frame from 0; negative: of the prior map
  double stamp_s = 0.0;
  Pose2 map_from_base;
  KeptScan scan;

  bool operator==(const StoredScan&) const = default;
};

// Throws InputError for a file that is missing, truncated or of another kind.
std::vector<StoredScan> ReadScans(const std::string& path);
// All beams must satisfy CanBeKept(), as those of a mapper do; others could not be read back.
void WriteScans(const std::string& path, const std::vector<StoredScan>& scans);

}  // namespace depthgrid
