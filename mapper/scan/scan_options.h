// Settings of the conversion of depth images to scans.
#pragma once

#include "mapper/core/options.h"

namespace depthgrid {

// Which rows of the image make the scan.
enum class ScanMode {
  kFull,       // all of them: the whole obstacle band, and free space where the band is covered
  kRowBand,    // `band_rows` around the optical axis, read like a thick laser
  kCentreRow,  // the paper's: one row, read like a laser
};

// Where the camera's height above the floor comes from, and which way is up.
enum class FloorSource {
  kPose,   // the pose's z less floor_z_m
  kImage,  // the floor plane seen in the images, followed where none is seen
};

struct ScanOptions {
  ScanMode mode = ScanMode::kFull;
  // Beams over the camera's horizontal field of view, uniform in angle. More than the image's
  // columns are useless, as beams that share a column share its error.
  int beams = 640;
  // The obstacle band above the floor. The lower edge is above the noise of the floor at 6 m
  // (Kinect: sigma 50 mm in depth at 10 degrees is 9 mm in height) and what wheels roll over; the
  // upper edge is above a person's shoulders and below door lintels.
  double band_low_m = 0.1;
  double band_high_m = 1.8;
  double min_range_m = 0.4;  // nearer depths are ignored (Kinect's and ICL-NUIM's limit)
  double max_range_m = 6.0;  // horizontal; farther returns only clear
  int band_rows = 10;        // of mode row_band
  // Least number of agreeing rows for a hit: 3 rows are 25 mm of height at 4 m, and no single wrong
  // pixel makes an obstacle.
  int min_returns = 3;
  // Largest vertical gap in the rays of free space: an obstacle that fits in it is no taller than
  // what lies below the band.
  double max_gap_m = 0.1;
  // Half height of the matched slice around the camera (see frame_scans.h); 0 matches the obstacle
  // scan, as for images below the horizon. 0.1 m contains three rows or more up to 6 m with a
  // tilted camera and is thin compared to furniture.
  double slice_half_height_m = 0.1;
  // Difference, in sigmas, beyond which the slice's outer parts are another surface than its inner
  // half (SteadyRange); 0: never. With pure noise 2.5 rejects one bearing in forty.
  double slice_agree_sigmas = 2.5;
  // Sigmas by which a surface in the slice must lean to be met at the slice's middle
  // (LeaningRange); 0: never. docs/tried.md, "The slice that is matched".
  double slice_lean_sigmas = 6.0;
  // Whether the slice omits surface ends cut by the camera's reach (cut_ends.h).
  bool drop_cut_ends = true;
  // SLAM drifts in height, roll and pitch too: with its poses the floor turns into walls
  // (docs/results.md, "Heights and tilts").
  FloorSource floor = FloorSource::kImage;
  double floor_z_m = 0.0;  // the floor in the frame of the poses; kImage begins there

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
