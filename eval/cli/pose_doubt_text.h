// What a user is told of poses that do not fit their images.
#pragma once

#include <string>

#include "mapper/io/pose_check.h"

namespace depthgrid::cli {

// How badly they fit, with what they would fit, and what is to be done about it: the poses are
// mapped as they were read.
std::string PoseDoubtText(const PoseDoubt& doubt);

}  // namespace depthgrid::cli
