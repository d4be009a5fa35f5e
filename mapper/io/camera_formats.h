// Camera files of other programs, told apart by their content (docs/formats.md, "Camera files").
#pragma once

#include <string>
#include <vector>

#include "mapper/core/slam_output.h"
#include "mapper/io/camera_file.h"

namespace depthgrid {

struct CameraDescription {
  std::string kind;  // for display: "ROS CameraInfo"
  CameraFile file;
  bool has_size = true;         // a bare matrix does not say width and height
  bool has_depth_scale = true;  // nor the units per metre
  // A camera.yaml without depth_scale gets the usual one, with a warning.
  bool takes_usual_scale = false;
  // fy is given negative (ICL-NUIM): the camera's y axis points up. `file` holds it positive, and
  // poses are to be turned by FlipY.
  bool y_up = false;
  // One for each size of image, of which the first image's is to be taken (`file` is empty).
  std::vector<PinholeCamera> sizes = {};
  std::string path = {};       // of the file, if it was read from one
  std::string mount_key = {};  // where it states the camera's place on a body, if it does
  std::string taken = {};      // what was taken for granted; empty if nothing was
};

// Our camera.yaml, those of camera_keys.h and realsense_listing.h, ORB-SLAM2/3 settings, or a text
// with fx fy cx cy or with a 3x3, 3x4 or 4x4 matrix. Throws InputError.
CameraDescription ReadCameraDescription(const std::string& path);
// Adds possible faults of the file to `warnings`.
CameraDescription ReadCameraDescription(const std::string& path,
                                        std::vector<std::string>& warnings);
CameraDescription ParseCameraDescription(const std::string& text, const std::string& place);
// Gives a camera without size that of `image_path`. Throws InputError if none of its sizes is this.
void TakeSize(int width_px, int height_px, const std::string& image_path,
              CameraDescription& camera);
// The warning that a camera file has no depth_scale, with the scale used.
std::string NoDepthScale(const std::string& path, double scale_per_m);

// The same pose with the y axes of camera and world flipped: S T S with S = diag(1, -1, 1, 1).
Pose3 FlipY(const Pose3& world_from_camera);
SlamOutput FlipY(SlamOutput slam);

}  // namespace depthgrid
