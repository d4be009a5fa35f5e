#include "mapper/io/gravity.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Patches across an image, whatever its size.
constexpr int kPatchesAcross = 80;
// Half the baseline of a normal as a share of the width: wide enough to average noise, narrow
// enough for furniture (6 of 640 pixels).
constexpr double kBaselineShare = 0.0094;
constexpr double kMaxDepthM = 5.0;         // farther normals are noise on real sensors
constexpr double kSameSurfaceShare = 0.1;  // depth change over the baseline, of the depth

const double kMaxFromImageUp = std::cos(RadFromDeg(50.0));
const double kCandidateCone = std::cos(RadFromDeg(6.0));
const double kFloorCone = std::cos(RadFromDeg(12.0));
constexpr std::size_t kCandidates = 300;
constexpr std::size_t kVoterStep = 3;
constexpr std::size_t kMinFloorPatches = 200;
constexpr double kMinFloorShare = 0.02;  // of all patches

constexpr double kHeightBinM = 0.05;
// The floor is the lowest level whose bin has this share of the fullest one.
constexpr double kFloorPeakShare = 0.25;
// Patches this near the plane take part in its fit, from the first to the last round.
constexpr double kFitBandM[] = {0.15, 0.10, 0.07, 0.05};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Plane {
  Eigen::Vector3d up;
  double height_m = 0.0;  // up . point
};

// The direction that most normals share, of a few hundred tried.
template <typename Patches>
Eigen::Vector3d CommonNormal(const Patches& patches) {
  Eigen::Vector3d best = patches.front().normal;
  std::size_t most = 0;
  const std::size_t step = std::max<std::size_t>(1, patches.size() / kCandidates);
  for (std::size_t i = 0; i < patches.size(); i += step) {
    std::size_t votes = 0;
    for (std::size_t k = 0; k < patches.size(); k += kVoterStep) {
      votes += patches[k].normal.dot(patches[i].normal) > kCandidateCone ? 1 : 0;
    }
    if (votes > most) {
      most = votes;
      best = patches[i].normal;
    }
  }
  return best;
}

template <typename Patches>
std::vector<Eigen::Vector3d> LevelPoints(const Patches& patches, const Eigen::Vector3d& up) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& patch : patches) {
    if (patch.normal.dot(up) >= kFloorCone) points.push_back(patch.point);
  }
  return points;
}

// Height of the lowest level that holds many of the points.
double LowestLevel(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& up) {
  double low = up.dot(points.front()), high = low;
  for (const Eigen::Vector3d& point : points) {
    low = std::min(low, up.dot(point));
    high = std::max(high, up.dot(point));
  }
  std::vector<int> bins(static_cast<std::size_t>((high - low) / kHeightBinM) + 1, 0);
  for (const Eigen::Vector3d& point : points) {
    ++bins[static_cast<std::size_t>((up.dot(point) - low) / kHeightBinM)];
  }
  const double enough = kFloorPeakShare * *std::max_element(bins.begin(), bins.end());
  std::size_t k = 0;
  while (bins[k] < enough) ++k;
  while (k + 1 < bins.size() && bins[k + 1] > bins[k]) ++k;
  return low + (static_cast<double>(k) + 0.5) * kHeightBinM;
}

// The plane through the points near the given one; over all frames, far points make it precise.
std::optional<Plane> FitNear(const std::vector<Eigen::Vector3d>& points, const Plane& plane,
                             double band_m, std::size_t needed) {
  std::vector<Eigen::Vector3d> near;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(plane.up.dot(point) - plane.height_m) > band_m) continue;
    near.push_back(point);
    mean += point;
  }
  if (near.size() < needed) return {};
  mean /= static_cast<double>(near.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : near) {
    scatter += (point - mean) * (point - mean).transpose();
  }
  Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  if (normal.dot(plane.up) < 0.0) normal = -normal;
  return Plane{normal, normal.dot(mean)};
}

}  // namespace

void GravityFinder::Add(const DepthImage& image, const PinholeCamera& camera,
                        const Pose3& world_from_camera) {
  cameras_.push_back(world_from_camera.translation);
  image_up_ += world_from_camera.rotation * -Eigen::Vector3d::UnitY();
  const int step_px = std::max(1, image.width_px / kPatchesAcross);
  const int base_px = std::max(2, static_cast<int>(kBaselineShare * image.width_px));
  const auto point_at = [&](int u, int v) { return Unproject(camera, u, v, image.At(u, v)); };
  for (int v = base_px; v + base_px < image.height_px; v += step_px) {
    for (int u = base_px; u + base_px < image.width_px; u += step_px) {
      const float z = image.At(u, v);
      if (!(z > 0.0F) || z > kMaxDepthM) continue;
      const float around[] = {image.At(u - base_px, v), image.At(u + base_px, v),
                              image.At(u, v - base_px), image.At(u, v + base_px)};
      const auto apart = [&](float other) {
        return !(other > 0.0F) || std::abs(other - z) > kSameSurfaceShare * z;
      };
      if (std::any_of(std::begin(around), std::end(around), apart)) continue;
      const Eigen::Vector3d along_u = point_at(u + base_px, v) - point_at(u - base_px, v);
      const Eigen::Vector3d along_v = point_at(u, v + base_px) - point_at(u, v - base_px);
      // x right times y down points away from the camera.
      const Eigen::Vector3d normal = along_v.cross(along_u).normalized();
      patches_.push_back({world_from_camera * point_at(u, v), world_from_camera.rotation * normal});
    }
  }
}

std::optional<Gravity> GravityFinder::Find() const {
  if (cameras_.empty() || image_up_.norm() == 0.0) return {};
  const Eigen::Vector3d image_up = image_up_.normalized();
  std::vector<Patch> upward;
  for (const Patch& patch : patches_) {
    if (patch.normal.dot(image_up) > kMaxFromImageUp) upward.push_back(patch);
  }
  const std::size_t needed =
      std::max(kMinFloorPatches,
               static_cast<std::size_t>(kMinFloorShare * static_cast<double>(patches_.size())));
  if (upward.size() < needed) return {};
  Plane floor{CommonNormal(upward), 0.0};
  for (std::size_t round = 0; round < std::size(kFitBandM); ++round) {
    const std::vector<Eigen::Vector3d> level = LevelPoints(upward, floor.up);
    if (level.size() < needed) return {};
    if (round == 0) floor.height_m = LowestLevel(level, floor.up);
    const auto fitted = FitNear(level, floor, kFitBandM[round], needed);
    if (!fitted) return {};
    floor = *fitted;
  }
  std::vector<double> heights_m;
  for (const Eigen::Vector3d& position : cameras_) {
    heights_m.push_back(floor.up.dot(position) - floor.height_m);
  }
  const double camera_height_m = Median(heights_m);
  if (camera_height_m <= 0.0) return {};
  return Gravity{floor.up, floor.height_m, camera_height_m};
}

}  // namespace depthgrid
