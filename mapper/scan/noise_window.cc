#include "mapper/scan/noise_window.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace depthgrid {
namespace {

// Classes of depth, each kRatio wide from kNearestM: 0.4 m to 9.2 m.
constexpr double kNearestM = 0.4;
constexpr double kRatio = 1.2165;  // 2^(1/3.54): sixteen classes

constexpr int kPixelStep = 8;  // 4,800 samples of a 640x480 image
// Rows between the three pixels: sensors smooth over a few pixels, which neighbours would hide.
constexpr int kLag = 3;

// The quantile of |second difference| that sigma is read from. High, because a quantised sensor
// gives mostly zeros; not higher, because edges of objects fill the top tenth of a furnished room.
constexpr double kQuantile = 0.8;
// That quantile of |N(0, 1)| times sqrt(1 + 4 + 1).
constexpr double kQuantileSigmas = 1.2816 * 2.4495;

constexpr std::size_t kMinSamples = 30;
// Until something is measured: Kinect v1 (Nguyen 2012) has 0.0012 to 0.0019 a metre.
constexpr double kDefaultInverseSigma = 0.002;

constexpr double kWindowSigmas = 6.0;
constexpr double kMinWindowM = 0.01;
// Wider than this, the window would join a chair with the wall behind it.
constexpr double kMaxWindowM = 0.4;

int ClassOf(double z_m) {
  const double position = std::log(z_m / kNearestM) / std::log(kRatio);
  return static_cast<int>(std::clamp(position, 0.0, NoiseWindow::kClasses - 1.0));
}

}  // namespace

NoiseWindow::NoiseWindow(const DepthImage& image) {
  std::array<std::vector<float>, kClasses> differences;
  for (int v = kLag; v + kLag < image.height_px; v += kPixelStep) {
    const float* above = image.Row(v - kLag);
    const float* here = image.Row(v);
    const float* below = image.Row(v + kLag);
    for (int u = kPixelStep / 2; u < image.width_px; u += kPixelStep) {
      if (!(above[u] > 0.0F && here[u] > 0.0F && below[u] > 0.0F)) continue;
      const float difference = 1.0F / above[u] - 2.0F / here[u] + 1.0F / below[u];
      differences[static_cast<std::size_t>(ClassOf(here[u]))].push_back(std::abs(difference));
    }
  }
  double last = kDefaultInverseSigma;
  std::array<bool, kClasses> measured{};
  for (std::size_t k = 0; k < kClasses; ++k) {
    auto& values = differences[k];
    measured[k] = values.size() >= kMinSamples;
    if (measured[k]) {
      const auto nth = values.begin() +
                       static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(values.size()));
      std::nth_element(values.begin(), nth, values.end());
      last = static_cast<double>(*nth) / kQuantileSigmas;
    }
    inverse_sigma_[k] = last;
  }
  // Classes nearer than the first measured one take its value.
  const auto first = std::find(measured.begin(), measured.end(), true) - measured.begin();
  if (first < kClasses) {
    std::fill_n(inverse_sigma_.begin(), first, inverse_sigma_[static_cast<std::size_t>(first)]);
  }
}

double NoiseWindow::SigmaM(double z_m) const {
  // Linear between the centres of the classes.
  const double position =
      std::clamp(std::log(z_m / kNearestM) / std::log(kRatio) - 0.5, 0.0, kClasses - 1.0);
  const auto below = std::min(static_cast<std::size_t>(position), std::size_t{kClasses - 2});
  const double share = position - static_cast<double>(below);
  const double inverse_sigma =
      (1.0 - share) * inverse_sigma_[below] + share * inverse_sigma_[below + 1];
  return z_m * z_m * inverse_sigma;
}

float NoiseWindow::At(float range_m) const {
  return static_cast<float>(std::clamp(kWindowSigmas * SigmaM(range_m), kMinWindowM, kMaxWindowM));
}

}  // namespace depthgrid
