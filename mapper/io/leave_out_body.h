// What a recording's camera sees of its own robot is found before anything else is done with it.
// Only for this folder's own files.
#pragma once

#include "mapper/io/depth_sequence.h"

namespace depthgrid::internal {

// Looks for the robot in a few images of the part, between which the camera turned, and lets the
// reader leave it out of all of them, with a warning.
void LeaveOutBody(const RecordingOptions& options, DepthSequence& sequence);

}  // namespace depthgrid::internal
