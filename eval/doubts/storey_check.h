// Whether a camera path is on the storey that the scene's floor is set to.
#pragma once

#include <optional>
#include <string>

#include "mapper/core/trajectory.h"
#include "sim/depth/ray_scene.h"
#include "sim/scene/scene.h"

namespace depthgrid {

// A warning when most of the path is above one level surface that could be the scene's floor and is
// a storey above the configured one. Furniture and platforms are not so high, stairs and ramps have
// many heights, and a surface that covers little of the scene cannot be its floor. Also when most
// of the path is below the configured floor.
std::optional<std::string> DoubtOfStorey(const Trajectory& trajectory, const Scene& scene,
                                         const RayScene& rays);

}  // namespace depthgrid
