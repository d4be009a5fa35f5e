// How far the rays of a bearing reached: nothing is free that none of them came to.
#pragma once

#include "mapper/core/depth_image.h"
#include "mapper/core/scan.h"
#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/bearing_returns.h"

namespace depthgrid {

// The largest horizontal range at which a row of the line has a usable depth, floor and ceiling
// among them, or the first that is `enough_m`; 0 where no depth is usable.
float FarthestSeen(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits,
                   float enough_m);

// Ends the free stretch of each beam without a hit where its farthest ray ended. Slopes alone do
// not tell: of a wall that shows fewer than min_returns rows, in a corner of a rolled image or
// between missing pixels, the rays count as seen and there is no hit to end them. Beam k is that of
// line k.
void EndWhereNothingWasSeen(const DepthImage& image, const BearingLineTable& lines,
                            const ReturnLimits& limits, Scan& scan);

}  // namespace depthgrid
