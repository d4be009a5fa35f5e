// Eq. 3 for one frame: fuses a predicted and a matched pose (docs/math.md, "Fusion"). Innovation,
// gain and covariance are in base axes of the predicted pose: forward (m), left (m), yaw (rad).
#pragma once

#include <Eigen/Core>

#include "mapper/core/frame_report.h"
#include "mapper/fuse/fusion_options.h"

namespace depthgrid {

struct FusedPose {
  Pose2 map_from_base;
  Eigen::Vector3d innovation = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double innovation_chi2 = 0.0;
  bool rejected = false;  // by the gate
};

// The matched pose relative to the predicted one; the angle is wrapped.
Eigen::Vector3d InnovationOf(const Pose2& predicted_map_from_base, const Pose2& map_from_base);

// The pose moved by gain * innovation. A zero gain returns `predicted` and a unit gain `matched`
// bit for bit.
Pose2 Moved(const Pose2& predicted_map_from_base, const Pose2& matched_map_from_base,
            const Eigen::Matrix3d& gain);

// Diagonal covariance matrix of independent errors.
Eigen::Matrix3d Squared(const Eigen::Vector3d& sigma);

// Pseudo-inverse: the covariance along observed directions, zero along others.
Eigen::Matrix3d SeenInverse(const Eigen::Matrix3d& information);

// Columns v such that vᵀ ν are the observed components of an innovation ν: one for each direction
// whose sigma is at most a thousand times the best one's.
using SeenBasisMatrix = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
SeenBasisMatrix SeenBasis(const Eigen::Matrix3d& information);

// nu^T S^-1 nu over the directions that a match observes.
struct InnovationSize {
  double chi2 = 0.0;
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();  // S^-1, zero along unobserved directions
  int directions = 0;
};
InnovationSize SeenSize(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& information,
                        const Eigen::Vector3d& innovation);

// A match's information for small motions in base axes of `pose`, which is close to its own. Needed
// even for a milliradian: across a wall, information is so much larger than along it.
Eigen::Matrix3d InformationIn(const Pose2& pose, const MatchResult& match);

// The same in base axes of the prediction, with information removed along the least certain
// direction of the prediction (in the plane) as far as an angular error of `tilt_rad` between walls
// and that direction could cause it; 0 removes nothing (docs/math.md, "Axes").
Eigen::Matrix3d InformationFor(const Prediction& prediction, const MatchResult& match,
                               double tilt_rad);

// Fusion with a given gain per axis, and the resulting covariance.
FusedPose FuseWithGain(const Prediction& prediction, const MatchResult& match,
                       const Eigen::Vector3d& gain);

// The Kalman gain K = (I + P L)^-1 P L with the match's information L, in base axes of the
// prediction (InformationIn): the information filter's update without inverting P or L, either of
// which may be singular.
FusedPose FuseKalman(const Prediction& prediction, const MatchResult& match);

// Information L after an independent error of covariance C is added: (L^-1 + C)^-1 = (I + L C)^-1
// L; L may be singular.
Eigen::Matrix3d WithAddedCovariance(const Eigen::Matrix3d& information,
                                    const Eigen::Matrix3d& covariance);

// Inverse covariance of the innovation, (P + L^-1)^-1.
Eigen::Matrix3d InnovationWeight(const Prediction& prediction, const Eigen::Matrix3d& information);

// nu^T (P + L^-1)^-1 nu.
double InnovationChi2(const Prediction& prediction, const Eigen::Matrix3d& information,
                      const Eigen::Vector3d& innovation);

// A small motion d before `b_from_a` is AdjointOf(b_from_a) d after it.
Eigen::Matrix3d AdjointOf(const Pose2& b_from_a);

// The covariance of a pose in the base axes it has after `motion` (base_before_from_base_after).
Eigen::Matrix3d Transported(const Eigen::Matrix3d& covariance, const Pose2& motion);

// Covariance added by one step of SLAM.
Eigen::Matrix3d SlamStepCovariance(const SlamNoiseOptions& noise, const Pose2& motion,
                                   double duration_s);

// The gain per axis that brings the estimate closest to the truth, in [0, 1]: what `oracle` takes.
Eigen::Vector3d OracleGain(const Pose2& true_map_from_base, const Pose2& predicted_map_from_base,
                           const Pose2& matched_map_from_base);

}  // namespace depthgrid
