#include "mapper/scan/floor_plane.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Samples along the longer side of the image: a floor that fills 1 % of it has 50.
constexpr int kSamplesAcross = 80;
// Slopes are measured over this many samples: 16 of 640 pixels are 5 cm at 1.5 m, where a Kinect's
// floor has a roughness of 7 mm.
constexpr int kSlopeSamples = 2;
constexpr float kSteepestSlope = 0.4F;
// Rows are prefetched this far ahead: the hardware prefetcher does not follow strides of several
// rows.
constexpr int kRowsAhead = 2;
// Camera heights considered: hand-held and robot-mounted. Bins are counted from the usual least
// height; those of a camera below it are negative.
constexpr float kUsualLeastHeightM = 0.1F;
constexpr float kMaxHeightM = 3.0F;
constexpr float kBinM = 0.02F;
constexpr int kBins = 145;
constexpr int kLowBins = 3;
constexpr float kLeastHeightM = kUsualLeastHeightM - kLowBins * kBinM;
// Farther floor is seen at a grazing angle and measured badly.
constexpr float kMaxDistanceM = 5.0F;
// A peak of three bins counts as a surface if it has this share of all samples.
constexpr double kMinImageShare = 0.01;
// Points farther than this from the plane have no weight, per iteration: tilt and height may be off
// at first; in the end rugs, door sills and chair feet must be excluded (with 6 cm they tilted the
// office room's floor by 0.9 degrees).
constexpr std::array<double, 6> kGatesM = {0.15, 0.1, 0.06, 0.04, 0.025, 0.025};
constexpr double kWidestGateSigmas = 2.5;
constexpr double kSigmaM = 0.02;  // of a point's height
// Errors of neighbouring points are correlated, so this many count as one.
constexpr double kPointsPerWitness = 10.0;
// The plane on which most points lie is known to a few centimetres.
constexpr double kDensestM = 0.03;
// A plane is another surface than that at the expected height if its height differs by more than
// this and than its tilt explains for points this far away (a floor is mostly seen from 1.5 to 5
// m).
constexpr double kOtherM = 0.04;
constexpr double kUsualDistanceM = 3.0;
// The fit is better than what has most points by chance, so that needs this many times as many.
constexpr double kManyMorePoints = 1.25;
// Points this near to a plane lie on it.
constexpr float kNearM = 0.01F;
// A plane tilted by more than this from the expected one is not the floor.
constexpr double kMostTilt = 0.15;

// Weighted sums over the points near a plane.
struct Sums {
  int used = 0;
  float w = 0.0F, x = 0.0F, y = 0.0F, z = 0.0F;
  float xx = 0.0F, xy = 0.0F, yy = 0.0F, xz = 0.0F, yz = 0.0F;
};

Sums SumsOver(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& plane,
              float gate_m) {
  Sums sums;
  for (const Eigen::Vector3f& p : points) {
    const float off = (p.z() - plane[0] - plane[1] * p.x() - plane[2] * p.y()) / gate_m;
    if (!(off * off < 1.0F)) continue;
    const float root = 1.0F - off * off;
    const float w = root * root;
    const float wx = w * p.x();
    const float wy = w * p.y();
    ++sums.used;
    sums.w += w;
    sums.x += wx;
    sums.y += wy;
    sums.z += w * p.z();
    sums.xx += wx * p.x();
    sums.xy += wx * p.y();
    sums.yy += wy * p.y();
    sums.xz += wx * p.z();
    sums.yz += wy * p.z();
  }
  return sums;
}

// z = plane[0] + plane[1] x + plane[2] y.
Eigen::Vector3d PlaneOf(const FloorPrior& prior) {
  return Eigen::Vector3d(-prior.height_m, -prior.up.x(), -prior.up.y()) / prior.up.z();
}

Eigen::Vector3d Solved(const Sums& sums, const FloorPrior& prior) {
  const auto square = [](double value) { return value * value; };
  Eigen::Matrix3d h;
  h << sums.w, sums.x, sums.y,   //
      sums.x, sums.xx, sums.xy,  //
      sums.y, sums.xy, sums.yy;
  Eigen::Vector3d g(sums.z, sums.xz, sums.yz);
  const double variance = kSigmaM * kSigmaM * kPointsPerWitness;
  h.diagonal() +=
      variance * Eigen::Vector3d(1.0 / square(prior.sigma_m), 1.0 / square(prior.sigma_rad),
                                 1.0 / square(prior.sigma_rad));
  const Eigen::Vector3d expected = PlaneOf(prior);
  g[0] += variance / square(prior.sigma_m) * expected[0];
  g.tail<2>() += variance / square(prior.sigma_rad) * expected.tail<2>();
  return h.ldlt().solve(g);
}

int PointsNear(const std::vector<Eigen::Vector3f>& points, const FloorPlane& plane) {
  const Eigen::Vector3f up = plane.up.cast<float>();
  const auto height = static_cast<float>(plane.height_m);
  int count = 0;
  for (const Eigen::Vector3f& p : points) count += std::abs(up.dot(p) + height) < kNearM ? 1 : 0;
  return count;
}

double MostOffM(const FloorPlane& plane) {
  return kOtherM + kUsualDistanceM * plane.up.head<2>().norm();
}

// The plane on which most points lie, of those at most kMostOffM from the expected height and
// tilted by whole degrees (a Hough transform), as a prior.
FloorPrior DensestPlane(const LevelPoints& level, const FloorPrior& expected) {
  constexpr int kDegrees = 4;           // twice the sigma of a first tilt (floor_tracker.cc)
  constexpr std::size_t kPoints = 400;  // of all, evenly chosen
  constexpr float kThickM = 0.01F;      // two slices are as thick as what counts as near a plane
  constexpr int kSlices = 48;
  constexpr float kMostOffM = 0.24F;  // half of all slices
  const std::size_t every = std::max<std::size_t>(1, level.points.size() / kPoints);
  const auto top = -static_cast<float>(expected.height_m) - kMostOffM;
  FloorPrior densest{expected.height_m, kDensestM, expected.sigma_rad};
  int most = 0;
  for (int i = -kDegrees; i <= kDegrees; ++i) {
    for (int j = -kDegrees; j <= kDegrees; ++j) {
      const auto a = static_cast<float>(RadFromDeg(i)), b = static_cast<float>(RadFromDeg(j));
      std::array<int, kSlices> slices{};
      for (std::size_t k = 0; k < level.points.size(); k += every) {
        const Eigen::Vector3f& p = level.points[k];
        const float slice = (p.z() - a * p.x() - b * p.y() - top) / kThickM;
        if (slice >= 0.0F && slice < kSlices) ++slices[static_cast<std::size_t>(slice)];
      }
      for (std::size_t k = 1; k < kSlices; ++k) {
        if (slices[k - 1] + slices[k] <= most) continue;
        most = slices[k - 1] + slices[k];
        densest.up =
            Eigen::Vector3d(static_cast<double>(-a), static_cast<double>(-b), 1.0).normalized();
        densest.height_m =
            static_cast<double>(-top - static_cast<float>(k) * kThickM) * densest.up.z();
      }
    }
  }
  return densest;
}

}  // namespace

void PointGrid::Resize(int row_count, int column_count) {
  constexpr std::size_t kLanes = 16;
  rows = row_count;
  columns = column_count;
  stride = (static_cast<std::size_t>(columns + kSlopeSamples) + kLanes - 1) / kLanes * kLanes;
  // Padding: vectors also read the last row beyond its end.
  const std::size_t size = static_cast<std::size_t>(rows) * stride + kLanes;
  for (std::vector<float>* numbers : {&x, &y, &z}) numbers->resize(size);
}

LevelPoints LevelPointsOf(const DepthImage& image, const PinholeCamera& camera,
                          const Eigen::Quaterniond& level_from_camera, LevelPoints memory,
                          bool is_low) {
  const int step = std::max(1, std::max(image.width_px, image.height_px) / kSamplesAcross);
  const int columns = image.width_px / step;
  const int rows = image.height_px / step;
  const Eigen::Matrix3f rotation = level_from_camera.toRotationMatrix().cast<float>();
  const Eigen::Vector3f ray_step = rotation.col(0) * static_cast<float>(step / camera.fx_px);
  memory.grid.Resize(rows, columns);
  for (int row = 0; row < rows; ++row) {
    const Eigen::Vector3f first_ray =
        rotation * Unproject(camera, 0.0, row * step, 1.0).cast<float>();
    const int coming = std::min(row + kRowsAhead, rows - 1);
    internal::PutPoints(image.Row(row * step), image.Row(coming * step), step, first_ray, ray_step,
                        row, memory.grid);
  }
  memory.samples = rows * columns;
  memory.points.clear();
  internal::FindLevel(memory.grid,
                      {is_low ? kLeastHeightM : kUsualLeastHeightM, kMaxHeightM, kMaxDistanceM,
                       kSteepestSlope, kSlopeSamples},
                      memory.points);
  return memory;
}

std::vector<LevelSurface> LevelSurfaces(const LevelPoints& level,
                                        std::vector<LevelSurface> memory) {
  constexpr std::size_t kMargin = 3;  // empty bins at either end
  constexpr std::size_t kZero = kMargin + kLowBins;
  std::array<int, kZero + kBins + kMargin> histogram{};
  for (const Eigen::Vector3f& point : level.points) {
    const int bin = static_cast<int>(std::floor((-point.z() - kUsualLeastHeightM) / kBinM));
    ++histogram[kMargin +
                static_cast<std::size_t>(kLowBins + std::clamp(bin, -kLowBins, kBins - 1))];
  }
  const auto peak = [&](std::size_t bin) {  // of three bins
    return histogram[bin - 1] + histogram[bin] + histogram[bin + 1];
  };
  const double enough = kMinImageShare * level.samples;
  memory.clear();
  for (std::size_t bin = kZero + kBins - 1; bin >= kMargin; --bin) {
    const int points = peak(bin);
    if (points < enough || points <= std::max(peak(bin + 1), peak(bin + 2)) ||
        points < std::max(peak(bin - 1), peak(bin - 2))) {
      continue;
    }
    // Its middle: how much more the bin above holds than that below.
    const double middle = static_cast<double>(bin) - static_cast<double>(kZero) + 0.5 +
                          static_cast<double>(histogram[bin + 1] - histogram[bin - 1]) / points;
    memory.push_back({kUsualLeastHeightM + middle * kBinM, points});
  }
  return memory;
}

// By least squares with Tukey's weights and the prior.
std::optional<FloorPlane> FitFloor(const LevelPoints& level, const FloorPrior& prior) {
  Eigen::Vector3d plane = PlaneOf(prior);
  Sums sums;
  for (const double gate_m : kGatesM) {
    // Skip gates that are wide compared with the prior.
    if (gate_m > kWidestGateSigmas * prior.sigma_m) continue;
    sums = SumsOver(level.points, plane.cast<float>(), static_cast<float>(gate_m));
    plane = Solved(sums, prior);
  }
  if (sums.used < kMinImageShare * level.samples) return {};
  if (plane.tail<2>().norm() > kMostTilt) return {};
  FloorPlane found;
  found.up = Eigen::Vector3d(-plane[1], -plane[2], 1.0).normalized();
  found.height_m = -plane[0] * found.up.z();
  found.points = PointsNear(level.points, found);
  return found;
}

std::optional<FloorPlane> FindFloorPlane(const LevelPoints& level, const FloorPrior& prior) {
  const auto is_other = [&](const FloorPlane& plane) {
    return std::abs(plane.height_m - prior.height_m) > MostOffM(plane);
  };
  std::optional<FloorPlane> best = FitFloor(level, prior);
  if (best && is_other(*best)) best.reset();
  // No plane can have many more points: on an even floor, mostly.
  if (best && kManyMorePoints * best->points >= static_cast<double>(level.points.size())) {
    return best;
  }
  const auto untilted = FitFloor(level, {prior.height_m, kDensestM, prior.sigma_rad});
  const auto densest = FitFloor(level, DensestPlane(level, prior));
  for (const std::optional<FloorPlane>& plane : {untilted, densest}) {
    if (!plane || is_other(*plane)) continue;
    if (!best || plane->points > kManyMorePoints * best->points) best = plane;
  }
  // What has fewer points than another surface may lead to that from the floor.
  const bool leads_away = best && densest && untilted && is_other(*densest) &&
                          densest->points > best->points &&
                          std::abs(best->height_m - prior.height_m) > kOtherM;
  return leads_away ? untilted : best;
}

}  // namespace depthgrid
