// Settings of the probability grids and of the map drawn at the end.
#pragma once

#include "mapper/core/options.h"

namespace depthgrid {

// What the cells of the finished map say.
enum class RasterRule {
  kLogOdds,  // the submaps' rule: clamped sum of log-odds
  kCounts,   // share of scans that ended in the cell, of all that saw it
};

struct GridOptions {
  double resolution_m = 0.05;  // of submaps and of the finished map
  // One update a cell and scan; values, clamps included, are Cartographer's (facts of its 2D
  // defaults): a hit weighs five misses, and a changed world is relearnt within 22 hits.
  double hit_prob = 0.55;
  double miss_prob = 0.49;
  double min_prob = 0.1;
  double max_prob = 0.9;
  RasterRule raster = RasterRule::kCounts;
  // `counts`: what a hit weighs against a miss. 5 is the ratio of the log-odds above.
  double hit_weight = 5.0;
  // `counts`: cells seen by fewer scans stay unknown.
  int min_observations = 1;
  // `counts`, of a drive that goes on in a finished map: where it sees a cell again, what drives
  // before it saw of that counts as so many scans at most, so that what was moved meanwhile comes
  // and goes. 0: all of them count alike.
  int earlier_scans = 4;
  // The finished map: a beam stops clearing this many cells before its hit, so that noisy and
  // grazing beams do not carve walls.
  double clear_margin_cells = 0.0;
  // The finished map: noise spreads the hits of one surface over several cells along the beams, and
  // behind it nothing passes to clear them. A cell with less surface than this share of the most
  // within the radius, along the direction it was seen, is not wall. 0 keeps every cell. Measured
  // with true poses (docs/results.md, "Finished map"): 2 % range noise, occupied F1 0.961 -> 0.999
  // and 0.921 -> 0.976; depth images with Handa noise 0.992 -> 0.990 and 0.993 -> 0.987.
  double min_surface_share = 0.35;
  double surface_radius_m = 0.1;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
