// The cells that a scan at a pose hit and passed. A cell is in at most one of the two sets (a hit
// outweighs any number of passes), and once for any number of beams: "hits before misses, one
// update per cell and scan".
#pragma once

#include "mapper/grid/cell_mask.h"
#include "mapper/grid/scan_segments.h"

namespace depthgrid {

// Both masks have the same rectangle.
struct ScanCells {
  CellMask hit;
  CellMask passed;  // cells crossed by a beam's clear interval, less those hit
};

// The reference: every beam's cells, one beam after the other.
ScanCells CellsOfScanPlain(const ScanSegments& segments);

}  // namespace depthgrid
