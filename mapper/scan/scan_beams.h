// Makes beams from an image's data for each bearing: the hit and the free stretch.
#pragma once

#include <vector>

#include "mapper/core/scan.h"
#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/bearing_returns.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// Slopes (height over horizontal distance) of the lowest and the highest of some rays of each
// bearing.
struct Slopes {
  std::vector<float> low, high;
};

// Slopes of the rays of each bearing; the last block is padded with bearings without rays. Memory
// is kept from frame to frame.
struct BearingViews {
  Slopes seen;  // where no ray was seen, low is infinite and high its negative
  // The largest unseen gaps between them below and above the horizon; nothing from 0 to 0.
  Slopes below, above;
  std::vector<char> has_gap;  // of each block
};

void FindViews(const BearingLineTable& lines, const std::vector<BlockViews>& rows,
               BearingViews& views);

// Memory for ScanOf, one number per beam, padded to whole blocks.
struct BeamNumbers {
  std::vector<float> clear_from_m, clear_to_m;
};

namespace internal {
// Slopes of the rays of a block.
void FindSlopes(const BearingLineBlock& lines, const BlockViews& rows, std::size_t block,
                BearingViews& views);
// ClearInterval of every bearing, up to its hit.
void FindClear(const BearingViews& views, const std::vector<BlockHits>& hits,
               double camera_height_m, const ScanOptions& options, BeamNumbers& beams);
}  // namespace internal

// `hits` need not be those found with `views`. `scan`: memory to reuse.
Scan ScanOf(const std::vector<Bearing>& bearings, const BearingViews& views,
            const std::vector<BlockHits>& hits, double camera_height_m, const ScanOptions& options,
            BeamNumbers& memory, Scan scan);

}  // namespace depthgrid
