// What a depth camera's reach cuts off a receding wall (docs/math.md, "Where a depth camera's reach
// ends").
#pragma once

#include "mapper/core/scan.h"
#include "mapper/scan/noise_window.h"

namespace depthgrid {

// Takes the hits from the end of each surface that recedes into bearings without any, as far away
// as anything was seen: of the pixels there only those are left that noise made short, so the wall
// seems to bend, and the bend goes where the camera goes. What lies within three sigmas of the
// end's depth is taken, unless it is half of the surface or more. `scan` is a level slice,
// `farthest_m` is NoiseWindow's of any image of the camera. Where the scan's own reach ends the
// surface nothing is cut off.
void DropCutEnds(const NoiseWindow& window, double farthest_m, Scan& scan);

}  // namespace depthgrid
