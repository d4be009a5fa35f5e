// Detects that innovations, each small compared to its noise, have the same direction for long:
// SLAM drifts more than was assumed.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

class DriftEvidence {
 public:
  // `weight`: inverse covariance of the innovation, zero along directions not seen.
  void Add(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight);

  // Chi-square of the weighted mean of recent innovations (exponential memory of 30 frames); 3 in
  // the mean for white innovations of the stated covariance.
  double Chi2() const;

 private:
  Eigen::Matrix3d weight_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace depthgrid
