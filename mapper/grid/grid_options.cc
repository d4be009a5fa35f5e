#include "mapper/grid/grid_options.h"

namespace depthgrid {

void GridOptions::Visit(OptionsVisitor& v) {
  v.Number("resolution_m", resolution_m, {0.005, 1.0}, "cell size of submaps and map, metres");
  v.Number("hit_prob", hit_prob, {0.5, 0.99},
           "probability that a cell is occupied, from one hit in it");
  v.Number("miss_prob", miss_prob, {0.01, 0.5},
           "probability that a cell is occupied, from one beam through it");
  v.Number("min_prob", min_prob, {0.001, 0.49}, "lower clamp of a submap's cells");
  v.Number("max_prob", max_prob, {0.51, 0.999}, "upper clamp of a submap's cells");
  v.Choice("raster", raster, {{RasterRule::kLogOdds, "log_odds"}, {RasterRule::kCounts, "counts"}},
           "how the finished map's cells are computed");
  v.Number("hit_weight", hit_weight, {0.1, 100.0}, "counts: weight of a hit relative to a miss");
  v.Number(
      "earlier_scans", earlier_scans, {0, 1000000},
      "counts: what earlier drives saw of a cell counts as this many scans at most; 0: all count");
  v.Number("min_observations", min_observations, {1, 1000},
           "counts: cells seen by fewer scans stay unknown");
  v.Number("clear_margin_cells", clear_margin_cells, {0.0, 10.0},
           "finished map: clearing stops this many cells before a hit");
  v.Number("min_surface_share", min_surface_share, {0.0, 1.0},
           "finished map: cells with less than this share of the most surface around them are not "
           "wall; 0 keeps all");
  v.Number("surface_radius_m", surface_radius_m, {0.0, 1.0},
           "finished map: how far around a cell its surface is compared, metres");
  v.Number("sharpen_sigmas", sharpen_sigmas, {0.0, 10.0},
           "finished map: a laser's hits that err by more than a cell are drawn on the wall they "
           "are of, so many standard deviations away at most; 0: where they were measured");
}

}  // namespace depthgrid
