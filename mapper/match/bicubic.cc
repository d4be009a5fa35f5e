#include "mapper/match/bicubic.h"

#include <cmath>

namespace depthgrid {
namespace {

// Weights of four neighbours for a point at the fraction t in [0, 1) from the second to the third.
struct SplineWeights {
  std::array<double, 4> value;
  std::array<double, 4> first;
  std::array<double, 4> second;
};

SplineWeights CatmullRom(double t) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return {{0.5 * (-t3 + 2.0 * t2 - t), 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
           0.5 * (-3.0 * t3 + 4.0 * t2 + t), 0.5 * (t3 - t2)},
          {0.5 * (-3.0 * t2 + 4.0 * t - 1.0), 0.5 * (9.0 * t2 - 10.0 * t),
           0.5 * (-9.0 * t2 + 8.0 * t + 1.0), 0.5 * (3.0 * t2 - 2.0 * t)},
          {-3.0 * t + 2.0, 9.0 * t - 5.0, -9.0 * t + 4.0, 3.0 * t - 1.0}};
}

// The first of four cells along an axis that a coordinate is interpolated from, and all weights.
struct Neighbours {
  int first_cell;
  SplineWeights weights;
};

Neighbours NeighboursOf(double coordinate_m, double resolution_m) {
  const double u = coordinate_m / resolution_m - 0.5;  // values are at cell centres
  const double u0 = std::floor(u);
  return {static_cast<int>(u0) - 1, CatmullRom(u - u0)};
}

}  // namespace

BicubicSample SampleBicubic(const ProbabilityView& view, const Eigen::Vector2d& point_in_map) {
  const double r = view.geometry.resolution_m;
  const auto [first_x, wx] = NeighboursOf(point_in_map.x(), r);
  const auto [first_y, wy] = NeighboursOf(point_in_map.y(), r);
  BicubicSample sample;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double p = view.At({first_x + i, first_y + j});
      sample.value += wx.value[i] * wy.value[j] * p;
      sample.dx += wx.first[i] * wy.value[j] * p / r;
      sample.dy += wx.value[i] * wy.first[j] * p / r;
      sample.dxx += wx.second[i] * wy.value[j] * p / (r * r);
      sample.dxy += wx.first[i] * wy.first[j] * p / (r * r);
      sample.dyy += wx.value[i] * wy.second[j] * p / (r * r);
    }
  }
  return sample;
}

SplineAlongAxis SplineAt(double coordinate_m, double resolution_m) {
  const Neighbours neighbours = NeighboursOf(coordinate_m, resolution_m);
  return {neighbours.first_cell, neighbours.weights.value};
}

double BicubicValue(const ProbabilityView& view, const Eigen::Vector2d& point_in_map) {
  const SplineAlongAxis x = SplineAt(point_in_map.x(), view.geometry.resolution_m);
  const SplineAlongAxis y = SplineAt(point_in_map.y(), view.geometry.resolution_m);
  double value = 0.0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      value += x.weights[i] * y.weights[j] * view.At({x.first_cell + i, y.first_cell + j});
    }
  }
  return value;
}

}  // namespace depthgrid
