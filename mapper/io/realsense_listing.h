// A RealSense camera's intrinsics as `rs-enumerate-devices -c` prints them: a block for each stream
// and size, of which those of the depth stream are read.
#pragma once

#include <string>
#include <string_view>

#include "mapper/io/camera_formats.h"

namespace depthgrid {

bool IsRealSenseListing(std::string_view text);
// One block gives the camera, several of them one for each size of image. Throws InputError.
CameraDescription ParseRealSenseListing(const std::string& text, const std::string& place);

// Throws InputError unless librealsense's rs2_distortion, by its names in Python and in C++ or by
// number, is plumb_bob's or distorts nothing; `key` is its name in the file.
void RequireRealSenseModel(std::string model, bool distorts, std::string_view key,
                           const std::string& place);

}  // namespace depthgrid
