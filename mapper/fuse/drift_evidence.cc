#include "mapper/fuse/drift_evidence.h"

#include <Eigen/Cholesky>

namespace depthgrid {
namespace {

constexpr double kMemoryFrames = 30.0;
constexpr double kRemembered = 1.0 - 1.0 / kMemoryFrames;
// Information added to every direction, for unobserved ones: 1 m or 1 rad, far below any match.
constexpr double kUnseenWeight = 1.0;

}  // namespace

void DriftEvidence::Add(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight) {
  weight_ = kRemembered * weight_ + weight;
  weighted_sum_ = kRemembered * weighted_sum_ + weight * innovation;
}

// The sum of k^i W v has covariance sum k^2i W, which is 1 / (1 + k) of sum k^i W once the start is
// forgotten.
double DriftEvidence::Chi2() const {
  const Eigen::Matrix3d known = weight_ + kUnseenWeight * Eigen::Matrix3d::Identity();
  return (1.0 + kRemembered) * weighted_sum_.dot(known.ldlt().solve(weighted_sum_));
}

}  // namespace depthgrid
