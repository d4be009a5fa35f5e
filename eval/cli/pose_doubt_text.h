// The message for poses that do not fit their images.
#pragma once

#include <string>

#include "mapper/io/pose_check.h"

namespace depthgrid::cli {

// States how badly they fit, which correction would fit, and how to apply it. The poses are used as
// read.
std::string PoseDoubtText(const PoseDoubt& doubt);

}  // namespace depthgrid::cli
