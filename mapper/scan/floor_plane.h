// The floor seen in a depth image.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/scan/camera_stand.h"

namespace depthgrid {

// A part of the image's pixels as points from the camera, ahead, to the left and up, that lie on
// surfaces which are level to within some 20 degrees.
struct LevelPoints {
  std::vector<Eigen::Vector3f> points;
  int samples = 0;  // pixels looked at

  // Memory: the points of the pixels looked at, not finite where there is none.
  std::vector<Eigen::Vector3f> grid;
};

LevelPoints LevelPointsOf(const DepthImage& image, const PinholeCamera& camera,
                          const Eigen::Quaterniond& level_from_camera, LevelPoints memory);

// How far below the camera the lowest level surface lies that fills 1 % of the image and a quarter
// of what the largest one fills; nothing when there is none. A table top that hides the floor is
// mistaken for it.
std::optional<double> LowestSurface(const LevelPoints& level);

// How well the plane is known before the image is looked at.
struct FloorPrior {
  double height_m = 0.0;
  double sigma_m = 0.0;
  double sigma_rad = 0.0;  // of roll and pitch
};

// Height and up, in the axes of the points, of the plane through them; nothing where too few
// of them agree on one.
struct FloorPlane {
  double height_m = 0.0;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};
std::optional<FloorPlane> FitFloor(const LevelPoints& level, const FloorPrior& prior);

}  // namespace depthgrid
