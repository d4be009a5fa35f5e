// Settings of recorded depth sequences of any folder layout.
#pragma once

#include <vector>

#include "mapper/core/options.h"

namespace depthgrid {

// Which stamp of a frame its pose is looked up by.
enum class PoseStamp { kColour, kDepth };

struct RecordingOptions {
  // Stamps closer than this belong together: depth with colour, images with poses. TUM RGB-D's
  // associate.py uses the same; at 30 Hz it is a bit more than half a frame.
  double max_stamp_difference_s = 0.02;
  // RGB-D SLAM systems stamp their poses by the colour image; choose depth when the poses belong to
  // the depth images' own stamps. Without colour images it is always depth.
  PoseStamp pose_stamp = PoseStamp::kColour;
  // Added to an image's stamp before its pose is looked up: positive when the poses' clock is
  // ahead.
  double time_offset_s = 0.0;
  // Between the two neighbouring poses instead of the nearest one; they may be this far apart.
  bool interpolate_poses = false;
  double max_interpolation_gap_s = 0.2;
  // Units of a depth image that mean "no measurement", besides 0.
  std::vector<double> invalid_units = {65535};
  // Stamps of folders whose images are only numbered: number / rate. 7-Scenes, 3DMatch and ScanNet
  // were recorded at 30 Hz.
  double frame_rate_hz = 30.0;
  // Units a metre; 0 takes the camera file's.
  double depth_scale_per_m = 0.0;
  // Parts of the robot in the images (BodyFinder) are no measurement.
  bool drop_body = true;

  void Visit(OptionsVisitor& v);
};

}  // namespace depthgrid
