#include "mapper/scan/floor_height.h"

#include <algorithm>
#include <vector>

namespace depthgrid {
namespace {

constexpr int kPixelStep = 4;
// Camera heights considered: hand-held and robot-mounted.
constexpr double kMinHeightM = 0.1;
constexpr double kMaxHeightM = 3.0;
constexpr double kBinM = 0.02;
constexpr int kBins = static_cast<int>((kMaxHeightM - kMinHeightM) / kBinM);
// Farther floor is seen at a grazing angle and says more about the tilt than about the height.
constexpr double kMaxDistanceM = 4.0;
// A peak of three bins counts as a surface with this share of all samples and this share of the
// highest peak: skirting boards and the noise below a floor have less, rugs and tables no lower
// surface.
constexpr double kMinImageShare = 0.01;
constexpr double kMinPeakShare = 0.25;
constexpr double kRefineM = 0.04;

std::vector<float> DropsBelowCamera(const DepthImage& image, const PinholeCamera& camera,
                                    const Eigen::Quaterniond& level_from_camera) {
  const Eigen::Matrix3d rotation = level_from_camera.toRotationMatrix();
  std::vector<float> drops_m;
  for (int v = 0; v < image.height_px; v += kPixelStep) {
    for (int u = 0; u < image.width_px; u += kPixelStep) {
      const double z_m = image.At(u, v);
      if (!(z_m > 0.0)) continue;
      const Eigen::Vector3d point = rotation * Unproject(camera, u, v, z_m);
      if (-point.z() < kMinHeightM || -point.z() >= kMaxHeightM ||
          point.head<2>().squaredNorm() > kMaxDistanceM * kMaxDistanceM) {
        continue;
      }
      drops_m.push_back(static_cast<float>(-point.z()));
    }
  }
  return drops_m;
}

}  // namespace

std::optional<double> CameraHeightFromFloor(const DepthImage& image, const PinholeCamera& camera,
                                            const Eigen::Quaterniond& level_from_camera) {
  const std::vector<float> drops_m = DropsBelowCamera(image, camera, level_from_camera);
  std::vector<int> histogram(kBins + 2, 0);  // one empty bin at either end
  for (const float drop_m : drops_m) {
    const int bin = static_cast<int>((drop_m - kMinHeightM) / kBinM);
    ++histogram[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1)) + 1];
  }
  const auto peak = [&](std::size_t bin) {
    return histogram[bin - 1] + histogram[bin] + histogram[bin + 1];
  };
  int highest = 0;
  for (std::size_t bin = 1; bin <= kBins; ++bin) highest = std::max(highest, peak(bin));
  const double samples = static_cast<double>(image.z_m.size()) / (kPixelStep * kPixelStep);
  const double enough = std::max(kMinImageShare * samples, kMinPeakShare * highest);
  std::size_t lowest = kBins;  // the largest drop whose peak is high enough
  while (lowest > 0 && peak(lowest) < enough) --lowest;
  if (lowest == 0) return {};
  // Up the flank to the top of the peak, then the median around it.
  while (lowest > 1 && peak(lowest - 1) > peak(lowest)) --lowest;
  const double centre_m = kMinHeightM + (static_cast<double>(lowest) - 0.5) * kBinM;
  std::vector<float> near;
  for (const float drop_m : drops_m) {
    if (std::abs(drop_m - centre_m) <= kRefineM) near.push_back(drop_m);
  }
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return *middle;
}

}  // namespace depthgrid
