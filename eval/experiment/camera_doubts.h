// Warnings about unlikely cameras.
#pragma once

#include <string>
#include <vector>

#include "sim/depth/sensor_options.h"

namespace depthgrid {

// Warns of a principal point outside the image and of pixels that are unintentionally not square,
// one line each. Throws InputError for settings of an impossible camera.
std::vector<std::string> DoubtsOfCamera(const SensorOptions& sensor);

}  // namespace depthgrid
