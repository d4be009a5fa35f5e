// What a scan at a pose says of the cells: which were hit and which were passed. A cell is in at
// most one of the two sets (a hit outweighs any number of passes), and once however many beams saw
// it: that is "hits before misses, one update a cell and scan".
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
