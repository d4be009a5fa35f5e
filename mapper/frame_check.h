// What a frame must hold to be mapped.
#pragma once

#include <optional>

#include "mapper/core/frame.h"

namespace depthgrid {

// Throws InputError, "frame 40: ...", for a frame that the mapper cannot use (IncrementalMapper::
// AddFrame says what that is). `camera`: of the depth images, if there are any.
void RequireSound(const Frame& frame, const std::optional<PinholeCamera>& camera);

}  // namespace depthgrid
