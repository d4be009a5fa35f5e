// What counts as an image of few columns, which is read with other steps.
#pragma once

namespace depthgrid {

// Between their pixels even a wall at 70 degrees of incidence recedes by more than what else counts
// as one surface, and seven of them span most things in a room.
constexpr int kFewColumns = 200;

}  // namespace depthgrid
