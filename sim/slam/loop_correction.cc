#include "sim/slam/loop_correction.h"

#include <Eigen/Dense>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

// Weight of rotation relative to translation: one radian costs as much as 2 m, a typical distance
// of an indoor scene.
constexpr double kMetresPerRad = 2.0;
constexpr int kIterations = 10;
constexpr double kConverged = 1e-12;  // metres and radians

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Lagrange multipliers (mu, lambda) of: minimise sum |w_k|^2 + |v_k|^2 / m^2 subject to
// sum w_k = turn and sum (v_k + w_k x d_k) = shift, where d_k leads from pose k to `second`. They
// give w_k = mu + d_k x lambda and v_k = m^2 lambda.
Vector6d Multipliers(const std::vector<Pose3>& poses, int fixed, int second,
                     const Vector6d& turn_and_shift) {
  const Eigen::Vector3d end = poses[static_cast<std::size_t>(second)].translation;
  Matrix6d system = Matrix6d::Zero();
  for (int k = fixed + 1; k <= second; ++k) {
    const Eigen::Matrix3d cross = CrossMatrix(end - poses[static_cast<std::size_t>(k)].translation);
    system.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
    system.topRightCorner<3, 3>() += cross;
    system.bottomLeftCorner<3, 3>() -= cross;
    system.bottomRightCorner<3, 3>() +=
        kMetresPerRad * kMetresPerRad * Eigen::Matrix3d::Identity() - cross * cross;
  }
  return system.ldlt().solve(turn_and_shift);
}

// Applies one Gauss-Newton step to each motion.
std::vector<Pose3> Bent(std::vector<Pose3> poses, int fixed, int second,
                        const Vector6d& multipliers) {
  const Eigen::Vector3d end = poses[static_cast<std::size_t>(second)].translation;
  const Eigen::Vector3d mu = multipliers.head<3>();
  const Eigen::Vector3d lambda = multipliers.tail<3>();
  Pose3 correction;
  for (std::size_t k = static_cast<std::size_t>(fixed) + 1; k < poses.size(); ++k) {
    if (k <= static_cast<std::size_t>(second)) {
      const Eigen::Vector3d to_end = end - poses[k].translation;
      const Eigen::Quaterniond turn = ExpRotation(mu + to_end.cross(lambda));
      const Eigen::Vector3d at = correction * poses[k].translation;
      const Eigen::Vector3d shift = kMetresPerRad * kMetresPerRad * lambda;
      correction = Pose3{turn, at - turn * at + shift} * correction;
    }
    poses[k] = correction * poses[k];
  }
  return poses;
}

}  // namespace

std::vector<Pose3> CorrectChain(std::vector<Pose3> poses, int fixed, int second,
                                const Pose3& target_of_second) {
  Require(fixed >= 0 && fixed < second && second < static_cast<int>(poses.size()),
          "a loop joins two different poses of the trajectory");
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Pose3& now = poses[static_cast<std::size_t>(second)];
    Vector6d turn_and_shift;
    turn_and_shift.head<3>() = LogRotation(target_of_second.rotation * now.rotation.conjugate());
    turn_and_shift.tail<3>() = target_of_second.translation - now.translation;
    if (turn_and_shift.norm() < kConverged) break;
    const Vector6d multipliers = Multipliers(poses, fixed, second, turn_and_shift);
    poses = Bent(std::move(poses), fixed, second, multipliers);
  }
  return poses;
}

}  // namespace depthgrid
