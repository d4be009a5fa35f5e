#include "mapper/scan/floor_plane.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

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
// Camera heights considered: hand-held and robot-mounted.
constexpr float kMinHeightM = 0.1F;
constexpr float kMaxHeightM = 3.0F;
constexpr float kBinM = 0.02F;
constexpr int kBins = 145;
// Farther floor is seen at a grazing angle and measured badly.
constexpr float kMaxDistanceM = 5.0F;
// A peak of three bins counts as a surface if it has this share of all samples and this share of
// the highest peak. Skirting boards and noise below a floor have less.
constexpr double kMinImageShare = 0.01;
constexpr double kMinPeakShare = 0.25;
// Points farther than this from the plane have no weight, per iteration: tilt and height may be off
// at first; in the end rugs, door sills and chair feet must be excluded (with 6 cm they tilted the
// office room's floor by 0.9 degrees).
constexpr std::array<double, 6> kGatesM = {0.15, 0.1, 0.06, 0.04, 0.025, 0.025};
constexpr double kWidestGateSigmas = 2.5;
constexpr double kSigmaM = 0.02;  // of a point's height
// Errors of neighbouring points are correlated, so this many count as one.
constexpr double kPointsPerWitness = 10.0;
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
  g[0] -= variance / square(prior.sigma_m) * prior.height_m;
  return h.ldlt().solve(g);
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
                          const Eigen::Quaterniond& level_from_camera, LevelPoints memory) {
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
                      {kMinHeightM, kMaxHeightM, kMaxDistanceM, kSteepestSlope, kSlopeSamples},
                      memory.points);
  return memory;
}

std::optional<double> LowestSurface(const LevelPoints& level) {
  std::array<int, kBins + 2> histogram{};  // with one empty bin at either end
  for (const Eigen::Vector3f& point : level.points) {
    const int bin = static_cast<int>((-point.z() - kMinHeightM) / kBinM);
    ++histogram[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1)) + 1];
  }
  const auto peak = [&](std::size_t bin) {
    return histogram[bin - 1] + histogram[bin] + histogram[bin + 1];
  };
  int highest = 0;
  for (std::size_t bin = 1; bin <= kBins; ++bin) highest = std::max(highest, peak(bin));
  const double enough = std::max(kMinImageShare * level.samples, kMinPeakShare * highest);
  std::size_t lowest = kBins;  // the largest drop whose peak is high enough
  while (lowest > 0 && peak(lowest) < enough) --lowest;
  if (lowest == 0) return {};
  // Climb to the top of the peak.
  while (lowest > 1 && peak(lowest - 1) > peak(lowest)) --lowest;
  return kMinHeightM + (static_cast<double>(lowest) - 0.5) * kBinM;
}

// z = -height + a x + b y, by least squares with Tukey's weights and the prior.
std::optional<FloorPlane> FitFloor(const LevelPoints& level, const FloorPrior& prior) {
  Eigen::Vector3d plane(-prior.height_m, 0.0, 0.0);
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
  found.points = sums.used;
  return found;
}

}  // namespace depthgrid
