#include "mapper/io/images_up.h"

#include <cmath>
#include <optional>

#include "mapper/core/symmetric_eigen.h"

namespace depthgrid {
namespace {

// Images pitched by up to 37 degrees agree, whichever way the camera turns; those pitched so in
// portrait have z beside them by more. Chosen, not measured.
constexpr double kMostAgreement = 0.8, kLeastSideways = 0.75;
// Axes lie in a plane if their mean square along its normal is at most this (21 degrees), and at
// least kLeastTurn along each direction in it (they turn by 90 degrees: 0.18). Chosen.
constexpr double kMostOffPlane = 0.13, kLeastTurn = 0.15;
// Cameras that look straight down, to 6 degrees, do not tell up by their upward direction. Chosen.
constexpr double kLeastUpward = 0.1;

struct AxesPlane {
  Eigen::Vector3d normal;
  double off_plane;  // mean square along the normal
};

std::optional<AxesPlane> PlaneOfAxes(const Eigen::Matrix3d& scatter, int count) {
  const SymmetricEigen eigen = EigenOf(scatter / count);
  if (eigen.values[0] > kMostOffPlane || eigen.values[1] < kLeastTurn) return {};
  return AxesPlane{eigen.vectors.col(0), eigen.values[0]};
}

Eigen::Vector3d Along(const Eigen::Vector3d& direction, const Eigen::Vector3d& guide) {
  return direction.dot(guide) < 0.0 ? Eigen::Vector3d(-direction) : direction;
}

}  // namespace

void ImagesUp::Add(const Pose3& world_from_camera) {
  const Eigen::Vector3d x = world_from_camera.rotation * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = world_from_camera.rotation * Eigen::Vector3d::UnitY();
  ++count_;
  upward_ -= y;
  backward_ -= world_from_camera.rotation * Eigen::Vector3d::UnitZ();
  right_ += x;
  x_scatter_ += x * x.transpose();
  y_scatter_ += y * y.transpose();
}

// The y axes of a camera that goes back and forth and looks down steeply lie in a plane, too; what
// is right of it on its way out is left of it on its way back. If those that go out are so many
// more that this passes, the upward directions agree.
bool ImagesUp::IsBeside(const Eigen::Vector3d& direction) const {
  const double squares = direction.dot(x_scatter_ * direction);
  return std::abs(direction.dot(right_)) > kMostAgreement * std::sqrt(count_ * squares);
}

Eigen::Vector3d ImagesUp::Mean() const {
  if (count_ == 0 || upward_.norm() > kMostAgreement * count_) return upward_;
  if (std::abs(right_.z()) > kLeastSideways * count_) return Eigen::Vector3d::UnitZ();
  const auto of_x = PlaneOfAxes(x_scatter_, count_);
  const auto of_y = PlaneOfAxes(y_scatter_, count_);
  // Cameras look down rather than up.
  if (of_y && IsBeside(of_y->normal) && !(of_x && of_x->off_plane <= of_y->off_plane)) {
    return Along(of_y->normal, backward_);
  }
  if (!of_x) return upward_;
  const bool is_told = std::abs(of_x->normal.dot(upward_)) > kLeastUpward * count_;
  return Along(of_x->normal, is_told ? upward_ : backward_);
}

}  // namespace depthgrid
