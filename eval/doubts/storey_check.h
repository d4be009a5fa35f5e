// Whether a camera path goes over the floor that its scene's map is of.
#pragma once

#include <optional>
#include <string>

#include "mapper/core/trajectory.h"
#include "sim/depth/ray_scene.h"
#include "sim/scene/scene.h"

namespace depthgrid {

// What to say when most of the path is above one level surface which could be the scene's floor
// itself and lies a storey above the one that it has. Neither furniture nor a platform is so high,
// stairs and ramps have many heights, and what covers little of the scene cannot be its floor.
std::optional<std::string> DoubtOfStorey(const Trajectory& trajectory, const Scene& scene,
                                         const RayScene& rays);

}  // namespace depthgrid
