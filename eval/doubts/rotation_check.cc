#include "eval/doubts/rotation_check.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "eval/metrics/alignment.h"
#include "eval/metrics/trajectory_metrics.h"
#include "mapper/core/angle.h"
#include "mapper/core/median.h"
#include "mapper/core/symmetric_eigen.h"

namespace depthgrid {
namespace {

// Possible error of a camera mount that was assumed to be level.
constexpr double kFitsRad = RadFromDeg(10.0);
// Largest share of the error left after removing a constant rotation.
constexpr double kConstantShare = 1.0 / 3.0;

using Rotations = std::vector<Eigen::Quaterniond>;

bool IsUpsideDown(const Similarity& fit) {
  constexpr double kLevelCos = 0.95;  // 18 degrees, more than level worlds differ
  const Eigen::Vector3d up = fit.reference_from_estimate.rotation * Eigen::Vector3d::UnitZ().eval();
  return up.z() < -kLevelCos;
}

// Standard deviations of the reference's positions along their principal axes, ascending.
Eigen::Vector3d ExtentsOf(const std::vector<PosePair>& pairs) {
  const auto n = static_cast<double>(pairs.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const PosePair& pair : pairs) mean += pair.reference.world_from_camera.translation / n;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d offset = pair.reference.world_from_camera.translation - mean;
    covariance += offset * offset.transpose() / n;
  }
  return EigenOf(covariance).values.cwiseMax(0.0).cwiseSqrt();
}

// The alignments from positions alone, where those fit and determine the rotation: in SE(3) a path
// must be wide compared to its errors, or the rotation about it would be arbitrary.
std::vector<Similarity> FitsOf(const std::vector<PosePair>& pairs) {
  constexpr double kMostMisfit = 0.1;  // of the extent
  constexpr double kLeastWidth = 5.0;  // of the misfit
  const Eigen::Vector3d extents_m = ExtentsOf(pairs);
  std::vector<Similarity> fits;
  if (const auto level = Align(pairs, Alignment::kSe2)) {
    const double misfit_m = Summarise(TranslationErrorsXy(Aligned(pairs, *level))).rmse;
    if (misfit_m < kMostMisfit * extents_m.z()) fits.push_back(*level);
  }
  if (const auto spatial = Align(pairs, Alignment::kSe3)) {
    const double misfit_m = Summarise(TranslationErrorsXyz(Aligned(pairs, *spatial))).rmse;
    const bool is_wide = extents_m.y() > kLeastWidth * misfit_m;
    if (IsUpsideDown(*spatial)) return fits;
    if (is_wide && misfit_m < kMostMisfit * extents_m.z()) fits.push_back(*spatial);
  }
  return fits;
}

// The reference's axes in the estimate's, pose by pose.
Rotations TurnsOf(const std::vector<PosePair>& pairs) {
  Rotations turns;
  for (const PosePair& pair : pairs) {
    turns.push_back(pair.estimate.world_from_camera.rotation.conjugate() *
                    pair.reference.world_from_camera.rotation);
  }
  return turns;
}

// Largest eigenvector of the sum of q q^T (Markley et al. 2007).
Eigen::Quaterniond MeanOf(const Rotations& rotations) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const Eigen::Quaterniond& q : rotations) sum += q.coeffs() * q.coeffs().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
  return Eigen::Quaterniond(Eigen::Vector4d(solver.eigenvectors().col(3)));
}

double MedianAngle(const Rotations& rotations, const Eigen::Quaterniond& from) {
  std::vector<double> angles_rad;
  for (const Eigen::Quaterniond& q : rotations) angles_rad.push_back(q.angularDistance(from));
  return UpperMedian(std::move(angles_rad));
}

// Errors of rotations: the least over all alignments.
struct Errors {
  double error_rad = kPi;   // as they are
  double spread_rad = kPi;  // about a constant rotation
  Eigen::Quaterniond constant = Eigen::Quaterniond::Identity();
};

Errors ErrorsOver(const std::vector<std::vector<PosePair>>& fits) {
  Errors errors;
  for (const std::vector<PosePair>& pairs : fits) {
    const Rotations turns = TurnsOf(pairs);
    const Eigen::Quaterniond mean = MeanOf(turns);
    const double spread_rad = MedianAngle(turns, mean);
    errors.error_rad =
        std::min(errors.error_rad, MedianAngle(turns, Eigen::Quaterniond::Identity()));
    if (spread_rad >= errors.spread_rad) continue;
    errors.spread_rad = spread_rad;
    errors.constant = mean;
  }
  return errors;
}

bool IsConstant(const Errors& errors, double error_rad) {
  return errors.spread_rad < kFitsRad && errors.spread_rad < kConstantShare * error_rad;
}

// Reinterprets quaternions that were read as x y z w as w x y z.
std::vector<PosePair> ReadWFirst(std::vector<PosePair> pairs) {
  for (PosePair& pair : pairs) {
    Eigen::Quaterniond& q = pair.estimate.world_from_camera.rotation;
    q = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w());
  }
  return pairs;
}

}  // namespace

bool FitsUpsideDown(const std::vector<PosePair>& pairs) {
  const auto fit = Align(pairs, Alignment::kSe3);
  return fit && IsUpsideDown(*fit);
}

bool PosesFit(const std::vector<PosePair>& pairs) {
  std::vector<std::vector<PosePair>> fitted;
  for (const Similarity& fit : FitsOf(pairs)) fitted.push_back(Aligned(pairs, fit));
  return ErrorsOver(fitted).error_rad < kFitsRad;
}

std::optional<RotationDoubt> CheckRotations(const std::vector<PosePair>& pairs) {
  constexpr std::size_t kLeastPoses = 10;
  if (pairs.size() < kLeastPoses) return std::nullopt;
  std::vector<std::vector<PosePair>> as_read, w_first;
  for (const Similarity& fit : FitsOf(pairs)) {
    as_read.push_back(Aligned(pairs, fit));
    w_first.push_back(Aligned(ReadWFirst(pairs), fit));
  }
  const Errors read = ErrorsOver(as_read);
  if (as_read.empty() || read.error_rad < kFitsRad) return std::nullopt;
  const Errors other = ErrorsOver(w_first);
  RotationDoubt doubt{read.error_rad, false, std::nullopt};
  if (other.error_rad < kFitsRad && other.error_rad < kConstantShare * read.error_rad) {
    doubt.w_first = true;
  } else if (IsConstant(read, read.error_rad)) {
    doubt.estimate_from_reference = read.constant;
  } else if (IsConstant(other, std::min(read.spread_rad, other.error_rad))) {
    doubt.w_first = true;
    doubt.estimate_from_reference = other.constant;
  } else {
    return std::nullopt;
  }
  return doubt;
}

}  // namespace depthgrid
