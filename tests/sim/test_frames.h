// Noise-free depth frames for tests of the sensor model.
#pragma once

#include <cmath>

#include "mapper/core/angle.h"
#include "mapper/core/level.h"
#include "sim/depth/depth_camera.h"
#include "sim/depth/sensor_options.h"
#include "tests/sim/test_meshes.h"

namespace depthgrid::test {

inline SensorOptions Options(DepthNoiseModel model) {
  SensorOptions options;
  options.noise = model;
  return options;
}

// All pixels have the same depth and incidence angle.
inline DepthFrame Constant(double z_m, double incidence_deg) {
  DepthFrame frame{DepthImage(640, 480), {}};
  frame.depth.z_m.assign(frame.depth.z_m.size(), static_cast<float>(z_m));
  frame.incidence_cos.assign(frame.depth.z_m.size(),
                             static_cast<float>(std::cos(RadFromDeg(incidence_deg))));
  return frame;
}

// A plane that fills the view, its normal turned by `turn_deg` about the vertical, `distance_m`
// from the camera along the optical axis.
inline DepthFrame PlaneFrame(double distance_m, double turn_deg) {
  const double turn = RadFromDeg(turn_deg);
  const Eigen::Vector3f along(static_cast<float>(40 * std::sin(turn)),
                              static_cast<float>(40 * std::cos(turn)), 0);
  const Eigen::Vector3f middle(static_cast<float>(distance_m), 0, 0), up(0, 0, 40);
  TriangleMesh mesh;
  AddQuad(mesh, middle - along - up, middle + along - up, middle + along + up, middle - along + up);
  return DepthCamera(RayScene(mesh), PinholeCamera{}).RenderWithIncidence(CameraOf({0, 0, 0}, 0));
}

}  // namespace depthgrid::test
