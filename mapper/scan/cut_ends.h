// Removes hits where a depth camera's reach ends a receding wall (docs/math.md, "Where a depth
// camera's reach ends").
#pragma once

#include "mapper/core/scan.h"
#include "mapper/scan/noise_window.h"

namespace depthgrid {

// Removes the hits at the end of each surface that recedes into bearings without hits near the
// greatest depth ever seen. Only pixels that noise made short remain there, so the wall seems to
// bend, and the bend moves with the camera. Hits within three sigmas of the end's depth are
// removed, unless they are half of the surface or more. `scan` is a level slice, `farthest_m` the
// largest NoiseWindow::farthest_m() so far. Surfaces that end at the scan's own max_range_m are
// left as they are if the camera sees farther; else hits within 2.5 sigmas of both are removed.
void DropCutEnds(const NoiseWindow& window, double farthest_m, Scan& scan);

}  // namespace depthgrid
