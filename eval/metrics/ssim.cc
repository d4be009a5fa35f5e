#include "eval/metrics/ssim.h"

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/picture_filter.h"

namespace depthgrid {

std::optional<double> Ssim(const StateMap& truth, const StateMap& estimate, const CellSet& scored) {
  constexpr double kC1 = 0.01 * 0.01;
  constexpr double kC2 = 0.03 * 0.03;
  const Picture x = PictureOfStates(truth, {}, kWindowRadiusPx);
  const Picture y = PictureOfStates(estimate, {}, kWindowRadiusPx);
  const auto smoothed = [](const Picture& p) {
    return Smoothed(p, kWindowSigmaPx, kWindowRadiusPx);
  };
  const Picture mean_x = smoothed(x);
  const Picture mean_y = smoothed(y);
  const Picture xx = smoothed(Product(x, x));
  const Picture yy = smoothed(Product(y, y));
  const Picture xy = smoothed(Product(x, y));
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < scored.members.size(); ++i) {
    if (scored.members[i] == 0) continue;
    const auto width = static_cast<std::size_t>(scored.geometry.width_cells);
    const std::size_t at = x.Index(static_cast<int>(i % width) + kWindowRadiusPx,
                                   static_cast<int>(i / width) + kWindowRadiusPx);
    const double mx = mean_x.values[at];
    const double my = mean_y.values[at];
    const double covariance = xy.values[at] - mx * my;
    const double variances = xx.values[at] - mx * mx + yy.values[at] - my * my;
    sum += (2.0 * mx * my + kC1) * (2.0 * covariance + kC2) /
           ((mx * mx + my * my + kC1) * (variances + kC2));
    ++count;
  }
  return Ratio(sum, count);
}

}  // namespace depthgrid
