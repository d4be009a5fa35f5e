// Whether innovations, each small beside its own noise, point one way for long: a prior that was
// taken for nearly perfect and is not.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

class DriftEvidence {
 public:
  // `weight`: inverse covariance of the innovation, zero along directions not seen.
  void Add(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& weight);

  // Of the weighted mean of the last second or so of innovations (30 frames, forgotten
  // exponentially); 3 in the mean for white innovations as large as they say.
  double Chi2() const;

 private:
  Eigen::Matrix3d weight_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted_sum_ = Eigen::Vector3d::Zero();
};

}  // namespace depthgrid
