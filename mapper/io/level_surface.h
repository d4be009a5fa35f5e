// Level surfaces among patches of images: their heights and the planes through them. Internal to
// mapper/io.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mapper/io/surface_view.h"

namespace depthgrid::internal {

// Width of a bin of Levels.
constexpr double kHeightBinM = 0.05;

// The patches whose normal is within 12 degrees of `up`.
std::vector<Eigen::Vector3d> LevelPoints(const std::vector<SurfacePatch>& patches,
                                         const Eigen::Vector3d& up);

// Histogram of heights in bins of kHeightBinM. Sparse, as poses may be thousands of kilometres
// apart.
struct Levels {
  double low_m = 0.0;
  std::map<std::int64_t, int> bins;

  Levels(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up);

  double HeightM(std::int64_t bin) const;
  // The fullest bin; the lowest of several.
  std::pair<std::int64_t, int> Fullest() const;
  double FullestM() const;
  // The lowest level with many points.
  double LowestM() const;
};

// Scatter of the points near a height around their mean; the direction of least spread is the
// plane's normal.
struct PlaneFit {
  std::size_t points = 0;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
};

PlaneFit FitNear(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up,
                 double height_m, double band_m);

Eigen::Vector3d NormalOf(const Eigen::Matrix3d& scatter, const Eigen::Vector3d& up);

}  // namespace depthgrid::internal
