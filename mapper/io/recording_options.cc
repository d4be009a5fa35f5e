#include "mapper/io/recording_options.h"

#include <fmt/format.h>

namespace depthgrid {

void RecordingOptions::Visit(OptionsVisitor& v) {
  v.Number("max_stamp_difference_s", max_stamp_difference_s, {0.0, 10.0},
           "stamps closer than this belong together");
  v.Choice("pose_stamp", pose_stamp, {{PoseStamp::kColour, "colour"}, {PoseStamp::kDepth, "depth"}},
           "the image by whose stamp a frame's pose is looked up");
  v.Number("time_offset_s", time_offset_s, {-kMostTimeOffsetS, kMostTimeOffsetS},
           "added to an image's stamp before its pose is looked up");
  v.Flag("interpolate_poses", interpolate_poses,
         "interpolate between neighbouring poses instead of taking the nearest");
  v.Number("max_interpolation_gap_s", max_interpolation_gap_s, {0.0, 1e3},
           "poses further apart than this are not interpolated");
  v.Numbers("invalid_units", invalid_units, {0, 65535},
            "depth image values that mean no measurement, besides 0");
  v.Number("frame_rate_hz", frame_rate_hz, {1e-3, 1e4},
           "images per second, for folders whose images are only numbered");
  v.Number("depth_scale", depth_scale_per_m, {0.0, 1e6},
           "depth image units per metre; 0 takes the camera file's");
  v.Flag("drop_body", drop_body,
         "leave out what stays nearer than 1 m while the camera turns: the robot's own body");
  v.Flag("upside_down", upside_down,
         "whether the camera is mounted upside down; for finding up, the images stay as they are");
}

std::string OtherMount(const RecordingOptions& options) {
  return fmt::format("the camera is mounted {} (--set sequence.recording.upside_down={})",
                     options.upside_down ? "upright" : "upside down", !options.upside_down);
}

}  // namespace depthgrid
