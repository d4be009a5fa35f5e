// Distances from points to the nearest of many others.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace depthgrid {

// A k-d tree (Bentley 1975), whose search time hardly depends on how far away the points are.
class NearestPoints {
 public:
  // At least one target.
  explicit NearestPoints(std::vector<Eigen::Vector2d> targets);

  // Euclidean, exact.
  double DistanceFrom(const Eigen::Vector2d& point) const;

 private:
  // The smallest rectangle around the targets [begin, end), and the halves that it is split into.
  struct Node {
    Eigen::Vector2d least = Eigen::Vector2d::Zero();
    Eigen::Vector2d most = Eigen::Vector2d::Zero();
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t halves = 0;  // index of the first, the second follows; 0 for a leaf
  };
  void Split(std::size_t index);
  void Search(const Node& node, const Eigen::Vector2d& point, double& best_squared) const;

  std::vector<Eigen::Vector2d> targets_;
  std::vector<Node> nodes_;  // the first is the root
};

}  // namespace depthgrid
