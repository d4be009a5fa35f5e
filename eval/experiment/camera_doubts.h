// Cameras that are likely not meant.
#pragma once

#include <string>
#include <vector>

#include "sim/depth/sensor_options.h"

namespace depthgrid {

// A principal point beside the image, or pixels that are not square though nobody said so: a line
// each. Throws InputError for settings that make no camera.
std::vector<std::string> DoubtsOfCamera(const SensorOptions& sensor);

}  // namespace depthgrid
