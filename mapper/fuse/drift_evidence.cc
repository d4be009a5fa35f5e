#include "mapper/fuse/drift_evidence.h"

#include <Eigen/Cholesky>

namespace depthgrid {
namespace {

constexpr double kFrames = 30.0;
constexpr double kKept = 1.0 - 1.0 / kFrames;
// Directions that were not seen are known to a metre or a radian: far below any match.
constexpr double kUnseenInformation = 1.0;

}  // namespace

void DriftEvidence::Add(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight) {
  weight_ = kKept * weight_ + weight;
  weighted_sum_ = kKept * weighted_sum_ + weight * innovation;
}

// The sum of k^i W v has covariance sum k^2i W, which is 1 / (1 + k) of sum k^i W once the start is
// forgotten.
double DriftEvidence::Chi2() const {
  const Eigen::Matrix3d known = weight_ + kUnseenInformation * Eigen::Matrix3d::Identity();
  return (1.0 + kKept) * weighted_sum_.dot(known.ldlt().solve(weighted_sum_));
}

}  // namespace depthgrid
