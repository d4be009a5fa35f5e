// What a scan at a pose says of the cells: which were hit and which were passed. A cell is in at
// most one of the two sets (a hit outweighs any number of passes), and once however many beams saw
// it: that is "hits before misses, one update a cell and scan".
#pragma once

#include <vector>

#include "mapper/core/scan.h"
#include "mapper/grid/cell_mask.h"

namespace depthgrid {

// Both masks have the same rectangle.
struct ScanCells {
  CellMask hit;
  CellMask passed;  // cells crossed by a beam's clear interval, less those hit
};

// Beams in cell coordinates (metres / resolution) of the map frame.
struct ScanSegments {
  struct Segment {
    Eigen::Vector2d clear_from = Eigen::Vector2d::Zero();
    Eigen::Vector2d clear_to = Eigen::Vector2d::Zero();
    Eigen::Vector2d end = Eigen::Vector2d::Zero();  // of the hit
    bool clears = false;
    bool hit = false;
  };
  std::vector<Segment> beams;
  Cell min_cell;  // around all of them
  Cell max_cell;
};

// `clear_margin_m`: a beam stops clearing this far before its hit.
ScanSegments SegmentsOf(const Scan& scan, const Pose2& map_from_base, double resolution_m,
                        double clear_margin_m = 0.0);

// The reference: every beam's cells, one beam after the other.
ScanCells CellsOfScanPlain(const ScanSegments& segments);

}  // namespace depthgrid
