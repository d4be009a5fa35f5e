#include "mapper/io/level_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "mapper/core/angle.h"
#include "mapper/core/symmetric_eigen.h"

namespace depthgrid::internal {
namespace {

const double kFloorCone = std::cos(RadFromDeg(12.0));
// The floor is the lowest level whose bin has this share of the fullest one.
constexpr double kFloorPeakShare = 0.25;

}  // namespace

std::vector<Eigen::Vector3d> LevelPoints(const std::vector<SurfacePatch>& patches,
                                         const Eigen::Vector3d& up) {
  std::vector<Eigen::Vector3d> points;
  for (const SurfacePatch& patch : patches) {
    if (patch.normal.dot(up) >= kFloorCone) points.push_back(patch.point);
  }
  return points;
}

Levels::Levels(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up)
    : low_m(up.dot(points.front())) {
  for (const Eigen::Vector3d& point : points) low_m = std::min(low_m, up.dot(point));
  for (const Eigen::Vector3d& point : points) {
    ++bins[static_cast<std::int64_t>((up.dot(point) - low_m) / kHeightBinM)];
  }
}

double Levels::HeightM(std::int64_t bin) const {
  return low_m + (static_cast<double>(bin) + 0.5) * kHeightBinM;
}

std::pair<std::int64_t, int> Levels::Fullest() const {
  return *std::max_element(bins.begin(), bins.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
}

double Levels::FullestM() const { return HeightM(Fullest().first); }

double Levels::LowestM() const {
  const double enough = kFloorPeakShare * Fullest().second;
  auto lowest = bins.begin();
  while (lowest->second < enough) ++lowest;
  for (auto next = std::next(lowest); next != bins.end(); lowest = next++) {
    if (next->first != lowest->first + 1 || next->second <= lowest->second) break;
  }
  return HeightM(lowest->first);
}

PlaneFit FitNear(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up,
                 double height_m, double band_m) {
  PlaneFit fit;
  const auto near = [&](const Eigen::Vector3d& point) {
    return std::abs(up.dot(point) - height_m) <= band_m;
  };
  for (const Eigen::Vector3d& point : points) {
    if (!near(point)) continue;
    ++fit.points;
    fit.mean += point;
  }
  if (fit.points == 0) return fit;
  fit.mean /= static_cast<double>(fit.points);
  for (const Eigen::Vector3d& point : points) {
    if (near(point)) fit.scatter += (point - fit.mean) * (point - fit.mean).transpose();
  }
  return fit;
}

Eigen::Vector3d NormalOf(const Eigen::Matrix3d& scatter, const Eigen::Vector3d& up) {
  const Eigen::Vector3d normal = EigenOf(scatter).vectors.col(0);
  return normal.dot(up) < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace depthgrid::internal
