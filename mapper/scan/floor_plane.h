// The floor seen in a depth image.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"

namespace depthgrid {

// Points of the sampled pixels as separate arrays of x, y and z for SIMD; NaN where there is no
// point, as behind the last column.
struct PointGrid {
  int rows = 0, columns = 0;
  std::size_t stride = 0;  // row length in floats: whole vectors plus padding
  std::vector<float> x, y, z;

  void Resize(int row_count, int column_count);
};

// Points (forward, left, up from the camera, m) of sampled pixels on surfaces that are level to
// within some 20 degrees.
struct LevelPoints {
  std::vector<Eigen::Vector3f> points;
  int samples = 0;  // pixels sampled

  PointGrid grid;  // kept for its memory
};

// From 0.1 m below the camera on, or 0.04 m if it is low; to 3 m.
LevelPoints LevelPointsOf(const DepthImage& image, const PinholeCamera& camera,
                          const Eigen::Quaterniond& level_from_camera, LevelPoints memory,
                          bool is_low = false);

namespace internal {
// Limits on level surfaces: height below the camera, distance and steepness.
struct LevelLimits {
  float min_height_m, max_height_m, max_distance_m, steepest;
  int over;  // spacing, in samples, over which the slope is measured
};
// Converts a row of pixels to a row of the grid: every `step`th pixel, on the ray first + column *
// per_column. Prefetches `coming_pixels`.
void PutPoints(const float* pixels, const float* coming_pixels, int step,
               const Eigen::Vector3f& first, const Eigen::Vector3f& per_column, int row,
               PointGrid& grid);
// Appends the points on level surfaces, row by row.
void FindLevel(const PointGrid& grid, const LevelLimits& limits,
               std::vector<Eigen::Vector3f>& points);
}  // namespace internal

// A level surface that fills 1 % of the image or more.
struct LevelSurface {
  double height_m = 0.0;  // below the camera
  int points = 0;         // within 3 cm of it
};

// All of them, the lowest first. Those less than 6 cm apart count as one.
std::vector<LevelSurface> LevelSurfaces(const LevelPoints& level,
                                        std::vector<LevelSurface> memory = {});

// The floor plane expected before using the image.
struct FloorPrior {
  double height_m = 0.0;
  double sigma_m = 0.0;
  double sigma_rad = 0.0;                         // of roll and pitch
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // its normal, in the points' axes
};

// A plane in the points' axes: height of the camera above it and its normal.
struct FloorPlane {
  double height_m = 0.0;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  int points = 0;  // within 1 cm of it
};

// Fitted to the points that agree with the prior. Empty if they are too few.
std::optional<FloorPlane> FitFloor(const LevelPoints& level, const FloorPrior& prior);

// What FitFloor finds, unless many more points at about the prior's height lie on what it finds
// from the prior's plane alone or from the plane, tilted by up to 4 degrees, on which most points
// lie. FitFloor alone may lead from the top of a rug to the floor behind it.
std::optional<FloorPlane> FindFloorPlane(const LevelPoints& level, const FloorPrior& prior);

}  // namespace depthgrid
