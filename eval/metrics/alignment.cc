#include "eval/metrics/alignment.h"

#include <Eigen/SVD>
#include <limits>

#include "mapper/core/error.h"
#include "mapper/core/level.h"

namespace depthgrid {
namespace {

template <int kDim>
struct Fit {
  Eigen::Matrix<double, kDim, kDim> rotation;
  Eigen::Matrix<double, kDim, 1> translation;
  double scale = 1.0;
};

enum class Scale { kKept, kFitted };

// Umeyama 1991: the least-squares similarity from the estimate's positions to the reference's.
template <int kDim>
std::optional<Fit<kDim>> Umeyama(const std::vector<PosePair>& pairs, Scale scale) {
  using Vector = Eigen::Matrix<double, kDim, 1>;
  using Matrix = Eigen::Matrix<double, kDim, kDim>;
  const auto n = static_cast<double>(pairs.size());
  Vector mean_x = Vector::Zero();
  Vector mean_y = Vector::Zero();
  for (const PosePair& pair : pairs) {
    mean_x += pair.estimate.world_from_camera.translation.template head<kDim>() / n;
    mean_y += pair.reference.world_from_camera.translation.template head<kDim>() / n;
  }
  Matrix covariance = Matrix::Zero();
  double variance_x = 0.0;
  for (const PosePair& pair : pairs) {
    const Vector x = pair.estimate.world_from_camera.translation.template head<kDim>() - mean_x;
    const Vector y = pair.reference.world_from_camera.translation.template head<kDim>() - mean_y;
    covariance += y * x.transpose() / n;
    variance_x += x.squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Matrix> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double epsilon = std::numeric_limits<double>::epsilon();
  // Singular values come largest first.
  if (svd.info() != Eigen::Success || !(svd.singularValues()(kDim - 2) > epsilon)) {
    return std::nullopt;
  }
  Vector signs = Vector::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs(kDim - 1) = -1.0;
  Fit<kDim> fit;
  fit.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  if (scale == Scale::kFitted) fit.scale = svd.singularValues().dot(signs) / variance_x;
  fit.translation = mean_y - fit.scale * (fit.rotation * mean_x);
  return fit;
}

std::optional<Similarity> AlignSe2(const std::vector<PosePair>& pairs) {
  const auto fit = Umeyama<2>(pairs, Scale::kKept);
  if (!fit) return std::nullopt;
  const double yaw_rad = std::atan2(fit->rotation(1, 0), fit->rotation(0, 0));
  return Similarity{Lift({fit->translation.x(), fit->translation.y(), yaw_rad}), 1.0};
}

std::optional<Similarity> AlignSpatially(const std::vector<PosePair>& pairs, Scale scale) {
  const auto fit = Umeyama<3>(pairs, scale);
  if (!fit) return std::nullopt;
  return Similarity{{Eigen::Quaterniond(fit->rotation).normalized(), fit->translation}, fit->scale};
}

}  // namespace

std::optional<Similarity> Align(const std::vector<PosePair>& pairs, Alignment alignment) {
  Require(!pairs.empty(), "an alignment is of at least one pair of poses");
  const Pose3& reference = pairs.front().reference.world_from_camera;
  const Pose3& estimate = pairs.front().estimate.world_from_camera;
  switch (alignment) {
    case Alignment::kNone:
      return Similarity{};
    case Alignment::kOrigin:
      return Similarity{reference * Inverse(estimate), 1.0};
    case Alignment::kPlanarOrigin:
      return Similarity{Lift(BaseOf(reference) * Inverse(BaseOf(estimate))), 1.0};
    case Alignment::kSe2:
      return AlignSe2(pairs);
    case Alignment::kSe3:
      return AlignSpatially(pairs, Scale::kKept);
    case Alignment::kSim3:
      return AlignSpatially(pairs, Scale::kFitted);
  }
  Broken("an alignment is one of the ways");
}

std::vector<PosePair> Aligned(std::vector<PosePair> pairs, const Similarity& transform) {
  for (PosePair& pair : pairs) {
    Pose3& pose = pair.estimate.world_from_camera;
    pose.translation *= transform.scale;
    pose = transform.reference_from_estimate * pose;
  }
  return pairs;
}

}  // namespace depthgrid
