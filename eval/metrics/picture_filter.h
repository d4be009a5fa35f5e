// Grey-scale pictures of maps and their smoothing, for metrics from image processing.
#pragma once

#include <vector>

#include "mapper/core/occupancy_map.h"

namespace depthgrid {

// Row by row, in the order of a grid's cells.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  double& At(int x, int y) { return values[Index(x, y)]; }
  double At(int x, int y) const { return values[Index(x, y)]; }
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

// The grey value of each state.
struct Shades {
  double unknown = 0.5;
  double free = 0.0;
  double occupied = 1.0;
};
Picture PictureOfStates(const StateMap& map, const Shades& shades, int margin_cells);

// The window of structural similarity, 11 x 11 (Wang et al. 2004).
constexpr double kWindowSigmaPx = 1.5;
constexpr int kWindowRadiusPx = 5;

// Smoothed with a Gaussian window of 2 radius + 1 pixels whose weights add up to one; beyond the
// edge the edge pixels are repeated.
Picture Smoothed(const Picture& picture, double sigma_px, int radius_px);

// Pixel by pixel.
Picture Product(const Picture& a, const Picture& b);

}  // namespace depthgrid
