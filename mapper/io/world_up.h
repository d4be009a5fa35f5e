// The up axis of a recording's world, and its poses in a world whose z is up.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "mapper/core/slam_output.h"

namespace depthgrid {

enum class WorldUp { kAuto, kX, kMinusX, kY, kMinusY, kZ, kMinusZ };

// The unit vector of a fixed axis; kAuto is none.
Eigen::Vector3d AxisOf(WorldUp up);
std::string NameOf(WorldUp up);  // "-y"

// The axis within a degree of `up`, or within `within_rad` if that is more (for an uncertain `up`);
// kAuto when there is none. So a world that is level by construction is not changed.
WorldUp NearestAxis(const Eigen::Vector3d& up, double within_rad = 0.0);

// The smallest rotation that makes `up` z; the identity for z itself.
Eigen::Quaterniond LevelFromWorld(const Eigen::Vector3d& up);

// Poses after a rotation of their world. The identity returns them bit for bit; relative poses
// (loops) do not change.
SlamOutput Rotated(SlamOutput slam, const Eigen::Quaterniond& level_from_world);

}  // namespace depthgrid
