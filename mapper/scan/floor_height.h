// The camera's height above the floor, from the floor itself.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"

namespace depthgrid {

// The lowest level surface that fills a sizeable part of the image below the horizon, as the
// camera's height above it; nothing when there is none. Level to within the error of
// `level_from_camera` (a few degrees are bridged); a table top that hides the floor is mistaken for
// it.
std::optional<double> CameraHeightFromFloor(const DepthImage& image, const PinholeCamera& camera,
                                            const Eigen::Quaterniond& level_from_camera);

}  // namespace depthgrid
