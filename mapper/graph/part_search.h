// Lays one part of a map over another. What is ambiguous of two places a few metres wide seldom is
// of whole parts (docs/math.md, "Torn maps").
#pragma once

#include <optional>

#include "mapper/graph/loop_overlap.h"

namespace depthgrid {

// The pose of the second part in axes of the first at which what both saw agrees best, to about a
// decimetre: exhaustive within 2 m and 12 degrees of `around`, about the middle of what the second
// one saw. Empty if they agree nowhere, or nearly as well elsewhere.
std::optional<Pose2> SearchPart(const SeenPlace& first, const SeenPlace& second,
                                const Pose2& around);

}  // namespace depthgrid
