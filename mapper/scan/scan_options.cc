#include "mapper/scan/scan_options.h"

namespace depthgrid {

void ScanOptions::Visit(OptionsVisitor& v) {
  v.Choice("mode", mode,
           {{ScanMode::kFull, "full"},
            {ScanMode::kRowBand, "row_band"},
            {ScanMode::kCentreRow, "centre_row"}},
           "rows that make the scan: all, a band around the centre, or the paper's centre row");
  v.Number("beams", beams, {8, 16384}, "number of bearings over the field of view");
  v.Number("band_low_m", band_low_m, {-10.0, 10.0},
           "lower edge of the obstacle band, above the floor");
  v.Number("band_high_m", band_high_m, {-10.0, 100.0},
           "upper edge of the obstacle band, above the floor");
  v.Number("min_range_m", min_range_m, {0.0, 100.0}, "nearer depth is not trusted");
  v.Number("max_range_m", max_range_m, {0.1, 1000.0}, "farther returns only clear cells");
  v.Less("band_low_m", band_low_m, "band_high_m", band_high_m);
  v.Less("min_range_m", min_range_m, "max_range_m", max_range_m);
  v.Number("band_rows", band_rows, {1, 16384}, "rows of mode row_band");
  v.Number("min_returns", min_returns, {1, 1000}, "rows that must agree on an obstacle");
  v.Number("max_gap_m", max_gap_m, {0.0, 10.0}, "largest unseen gap in height within free space");
  v.Number("slice_half_height_m", slice_half_height_m, {0.0, 1.0},
           "half the height of the level slice around the camera that is matched; 0 matches the "
           "obstacle scan");
  v.Number("slice_agree_sigmas", slice_agree_sigmas, {0.0, 1000.0},
           "where the slice's upper or lower part stands farther from its inner half than this "
           "many sigmas, the inner half alone is matched; 0 takes all for one surface");
  v.Number("slice_lean_sigmas", slice_lean_sigmas, {0.0, 1000.0},
           "where the slice's surface leans by more sigmas than this, it is matched at the slice's "
           "middle height; 0 takes all for upright");
  v.Flag(
      "drop_cut_ends", drop_cut_ends,
      "whether the end of a wall that recedes beyond the camera's reach is left out of matching");
  v.Choice(
      "floor", floor, {{FloorSource::kPose, "pose"}, {FloorSource::kImage, "image"}},
      "camera height and tilt over the floor: from the pose or from the floor seen in the image");
  v.Number("floor_z_m", floor_z_m, {-1e6, 1e6}, "z of the floor in the frame of the poses");
}

}  // namespace depthgrid
