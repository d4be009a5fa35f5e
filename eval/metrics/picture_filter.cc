#include "eval/metrics/picture_filter.h"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

std::vector<double> GaussianWeights(double sigma_px, int radius_px) {
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = -radius_px; i <= radius_px; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace

Picture PictureOfStates(const StateMap& map, const Shades& shades, int margin_cells) {
  const int width = map.geometry.width_cells;
  const int height = map.geometry.height_cells;
  Picture picture{width + 2 * margin_cells, height + 2 * margin_cells, {}};
  picture.values.assign(
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
      shades.unknown);
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    const int x = static_cast<int>(i % static_cast<std::size_t>(width)) + margin_cells;
    const int y = static_cast<int>(i / static_cast<std::size_t>(width)) + margin_cells;
    const CellState state = map.states[i];
    picture.At(x, y) = state == CellState::kOccupied ? shades.occupied
                       : state == CellState::kFree   ? shades.free
                                                     : shades.unknown;
  }
  return picture;
}

Picture Smoothed(const Picture& picture, double sigma_px, int radius_px) {
  const std::vector<double> weights = GaussianWeights(sigma_px, radius_px);
  const auto clamped = [](int i, int count) { return std::clamp(i, 0, count - 1); };
  Picture rows = picture;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      double sum = 0.0;
      for (int k = -radius_px; k <= radius_px; ++k) {
        sum += weights[static_cast<std::size_t>(k + radius_px)] *
               picture.At(clamped(x + k, picture.width), y);
      }
      rows.At(x, y) = sum;
    }
  }
  Picture smooth = picture;
  std::fill(smooth.values.begin(), smooth.values.end(), 0.0);
  for (int y = 0; y < picture.height; ++y) {
    for (int k = -radius_px; k <= radius_px; ++k) {
      const double weight = weights[static_cast<std::size_t>(k + radius_px)];
      const double* from = &rows.values[rows.Index(0, clamped(y + k, picture.height))];
      double* to = &smooth.values[smooth.Index(0, y)];
      for (int x = 0; x < picture.width; ++x) to[x] += weight * from[x];
    }
  }
  return smooth;
}

Picture Product(const Picture& a, const Picture& b) {
  Picture product = a;
  for (std::size_t i = 0; i < a.values.size(); ++i) product.values[i] *= b.values[i];
  return product;
}

}  // namespace depthgrid
