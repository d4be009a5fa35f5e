// The floor seen in a depth image.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"

namespace depthgrid {

// The points of the pixels looked at, each number of theirs side by side for vectors; not numbers
// where there is none, as behind the last column.
struct PointGrid {
  int rows = 0, columns = 0;
  std::size_t stride = 0;  // numbers of a row: whole vectors, and some columns to spare
  std::vector<float> x, y, z;

  void Resize(int row_count, int column_count);
};

// A part of the image's pixels as points from the camera, ahead, to the left and up, that lie on
// surfaces which are level to within some 20 degrees.
struct LevelPoints {
  std::vector<Eigen::Vector3f> points;
  int samples = 0;  // pixels looked at

  PointGrid grid;  // memory
};

LevelPoints LevelPointsOf(const DepthImage& image, const PinholeCamera& camera,
                          const Eigen::Quaterniond& level_from_camera, LevelPoints memory);

namespace internal {
// Surfaces that are looked at: their height below the camera, how far they are and how steep.
struct LevelLimits {
  float min_height_m, max_height_m, max_distance_m, steepest;
  int over;  // points between which the slope is looked at
};
// A row of pixels as a row of the grid: every `step`th pixel, on the ray first + column *
// per_column. `coming_pixels` are fetched meanwhile.
void PutPoints(const float* pixels, const float* coming_pixels, int step,
               const Eigen::Vector3f& first, const Eigen::Vector3f& per_column, int row,
               PointGrid& grid);
// Appends those that lie on a level surface, row by row.
void FindLevel(const PointGrid& grid, const LevelLimits& limits,
               std::vector<Eigen::Vector3f>& points);
}  // namespace internal

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
  int points = 0;  // that lie on it
};
std::optional<FloorPlane> FitFloor(const LevelPoints& level, const FloorPrior& prior);

}  // namespace depthgrid
