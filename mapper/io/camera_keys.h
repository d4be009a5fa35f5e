// Camera files of other programs that are YAML or JSON, told apart by their keys: ROS's CameraInfo,
// Open3D's intrinsics, a RealSense stream's, Kalibr's camera chain and EuRoC's sensor.yaml.
#pragma once

#include <optional>

#include "mapper/io/camera_formats.h"
#include "mapper/io/config.h"

namespace depthgrid {

// Nothing if it has the keys of none. Throws InputError.
std::optional<CameraDescription> CameraByKeys(const Config& config);

}  // namespace depthgrid
