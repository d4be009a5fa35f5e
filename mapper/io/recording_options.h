// Options of recorded depth sequences, for all folder layouts.
#pragma once

#include <string>
#include <vector>

#include "mapper/core/options.h"

namespace depthgrid {

// Which stamp of a frame is used to look up its pose.
enum class PoseStamp { kColour, kDepth };

constexpr double kMostTimeOffsetS = 1e10;  // stamps since 1970 beside those since the start

struct RecordingOptions {
  // Stamps closer than this belong together: depth with colour, images with poses. TUM RGB-D's
  // associate.py uses the same; at 30 Hz it is a bit more than half a frame.
  double max_stamp_difference_s = 0.02;
  // RGB-D SLAM systems stamp poses with the colour image; choose depth if the poses have the depth
  // images' stamps. Without colour images it is always depth.
  PoseStamp pose_stamp = PoseStamp::kColour;
  // Added to an image's stamp before its pose is looked up: positive when the poses' clock is
  // ahead. At most kMostTimeOffsetS.
  double time_offset_s = 0.0;
  // Interpolates between the two neighbouring poses, at most max_interpolation_gap_s apart, instead
  // of taking the nearest.
  bool interpolate_poses = false;
  double max_interpolation_gap_s = 0.2;
  // Values of a depth image that mean "no measurement", besides 0.
  std::vector<double> invalid_units = {65535};
  // For folders whose images are only numbered: stamp = number / rate. 7-Scenes, 3DMatch and
  // ScanNet were recorded at 30 Hz.
  double frame_rate_hz = 30.0;
  // Units per metre; 0: the camera file's.
  double depth_scale_per_m = 0.0;
  // Invalidates parts of the robot in the images (BodyFinder).
  bool drop_body = true;
  // For a camera mounted upside down: up is sought beyond the images' lower edge.
  bool upside_down = false;

  void Visit(OptionsVisitor& v);
};

// "the camera is mounted upside down (--set sequence.recording.upside_down=true)", of a camera that
// is not mounted as the options say.
std::string OtherMount(const RecordingOptions& options);

}  // namespace depthgrid
