// The farthest point that rays of a bearing reached, which limits free space.
#pragma once

#include "mapper/core/depth_image.h"
#include "mapper/core/scan.h"
#include "mapper/scan/bearing_lines.h"
#include "mapper/scan/bearing_returns.h"

namespace depthgrid {

// Largest horizontal range of any usable depth on the line, floor and ceiling included; stops at
// the first that reaches `enough_m`. 0 without usable depth.
float FarthestSeen(const DepthImage& image, const BearingLine& line, const ReturnLimits& limits,
                   float enough_m);

// Limits the free stretch of each beam without a hit to its farthest ray. Slopes alone do not
// suffice: a wall with fewer than min_returns rows, in a corner of a rolled image or between
// missing pixels, gives no hit although its rays were seen. Beam k belongs to line k.
void EndWhereNothingWasSeen(const DepthImage& image, const BearingLineTable& lines,
                            const ReturnLimits& limits, Scan& scan);

}  // namespace depthgrid
