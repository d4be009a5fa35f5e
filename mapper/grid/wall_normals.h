// The normal of the wall at each hit of a scan.
#pragma once

#include <vector>

#include "mapper/core/scan.h"

namespace depthgrid {

// A hit with the unit normal of its wall, away from the sensor; base axes.
struct WallHit {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
};

// The hits in the order of the beams; `hits` keeps its memory. The normal is that of the line
// through the neighbouring hits within `reach_m` without a jump of more than `reach_m`; without
// such neighbours, the beam's own direction.
void FindWallHits(const Scan& scan, double reach_m, std::vector<WallHit>& hits);

}  // namespace depthgrid
