// Removes the robot's own body from a recording's images, before any other processing. Internal to
// mapper/io.
#pragma once

#include "mapper/io/depth_sequence.h"

namespace depthgrid::internal {

// Finds the robot in a few images of the part between which the camera turned, makes the reader
// remove it from all images and adds a warning.
void LeaveOutBody(const RecordingOptions& options, DepthSequence& sequence);

}  // namespace depthgrid::internal
