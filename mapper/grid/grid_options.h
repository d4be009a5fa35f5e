// Settings of the probability grids and of the map drawn at the end.
#pragma once

#include "mapper/core/options.h"

namespace depthgrid {

// How the cells of the finished map are computed.
enum class RasterRule {
  kLogOdds,  // the submaps' rule: clamped sum of log-odds
  kCounts,   // share of scans that ended in the cell, of all that saw it
};

struct GridOptions {
  double resolution_m = 0.05;  // of submaps and of the finished map
  // At most one update per cell and scan; values and clamps are Cartographer's 2D defaults: a hit
  // weighs five misses, and a free cell becomes fully occupied within 22 hits.
  double hit_prob = 0.55;
  double miss_prob = 0.49;
  double min_prob = 0.1;
  double max_prob = 0.9;
  RasterRule raster = RasterRule::kCounts;
  // `counts`: weight of a hit relative to a miss. 5 is the ratio of the log-odds above.
  double hit_weight = 5.0;
  // `counts`: cells seen by fewer scans stay unknown.
  int min_observations = 1;
  // `counts`, when continuing a finished map: in cells seen again, earlier drives count as at most
  // this many scans, so that changes since then show. 0: no limit.
  int earlier_scans = 4;
  // The finished map: a beam stops clearing this many cells before its hit, so that noisy and
  // grazing beams do not carve walls.
  double clear_margin_cells = 0.0;
  // The finished map: noise spreads the hits of one surface over several cells along the beams, and
  // no beam clears those behind it. A cell with less surface than this share of the maximum within
  // the radius, along the viewing direction, is not wall. 0 keeps every cell. Measured with true
  // poses (docs/results.md, "Finished map"): 2 % range noise, occupied F1 0.961 -> 0.999 and 0.921
  // -> 0.976; depth images with Handa noise 0.992 -> 0.990 and 0.993 -> 0.987.
  double min_surface_share = 0.35;
  double surface_radius_m = 0.1;
  // The finished map: where a laser's noise is much wider than a cell, its hits that err by more
  // than a cell (one standard deviation) are drawn on the wall they are of, if it is within this
  // many standard deviations along the beam. 0: where they were measured. 3 % range noise, occupied
  // F1 0.917 -> 0.979 (docs/results.md, "Finished map").
  double sharpen_sigmas = 4.0;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
