#include "eval/metrics/nearest_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

constexpr std::size_t kMostOfALeaf = 8;

// Rounded subtraction, square and sum are monotonic, so this is no more than the computed distance
// to any point of the rectangle, and leaving it out changes no bit.
double SquareFrom(const Eigen::Vector2d& point, const Eigen::Vector2d& least,
                  const Eigen::Vector2d& most) {
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  const Eigen::Vector2d outside = (least - point).cwiseMax(point - most).cwiseMax(zero);
  return outside.squaredNorm();
}

}  // namespace

NearestPoints::NearestPoints(std::vector<Eigen::Vector2d> targets) : targets_(std::move(targets)) {
  Require(!targets_.empty(), "a nearest point is one of at least one");
  nodes_.push_back({.begin = 0, .end = targets_.size()});
  for (std::size_t i = 0; i < nodes_.size(); ++i) Split(i);
}

void NearestPoints::Split(std::size_t index) {
  Node node = nodes_[index];
  node.least = node.most = targets_[node.begin];
  for (std::size_t i = node.begin; i < node.end; ++i) {
    node.least = node.least.cwiseMin(targets_[i]);
    node.most = node.most.cwiseMax(targets_[i]);
  }
  if (node.end - node.begin > kMostOfALeaf) {
    const Eigen::Vector2d size = node.most - node.least;
    const int axis = size.x() >= size.y() ? 0 : 1;
    const std::size_t middle = node.begin + (node.end - node.begin) / 2;
    const auto at = [&](std::size_t i) {
      return targets_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(
        at(node.begin), at(middle), at(node.end),
        [axis](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a[axis] < b[axis]; });
    node.halves = nodes_.size();
    nodes_.push_back({.begin = node.begin, .end = middle});
    nodes_.push_back({.begin = middle, .end = node.end});
  }
  nodes_[index] = node;
}

double NearestPoints::DistanceFrom(const Eigen::Vector2d& point) const {
  double best_squared = std::numeric_limits<double>::infinity();
  Search(nodes_.front(), point, best_squared);
  return std::sqrt(best_squared);
}

void NearestPoints::Search(const Node& node, const Eigen::Vector2d& point,
                           double& best_squared) const {
  if (node.halves == 0) {
    for (std::size_t i = node.begin; i < node.end; ++i) {
      best_squared = std::min(best_squared, (targets_[i] - point).squaredNorm());
    }
    return;
  }
  std::array<std::pair<double, const Node*>, 2> halves;
  for (std::size_t k = 0; k < 2; ++k) {
    const Node& half = nodes_[node.halves + k];
    halves[k] = {SquareFrom(point, half.least, half.most), &half};
  }
  if (halves[1].first < halves[0].first) std::swap(halves[0], halves[1]);
  for (const auto& [square, half] : halves) {
    if (square < best_squared) Search(*half, point, best_squared);
  }
}

}  // namespace depthgrid
