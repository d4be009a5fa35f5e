#include "mapper/surfel/motion_sigma.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// The prior is never believed beyond this, a frame: simulated priors can be perfect.
const Eigen::Vector3d kLeastMotionSigma(1e-5, 1e-5, 2e-6);
// Nor is it in one direction so much better than in another: in a corridor nothing tells how it
// errs lengthways, and a direction's sigma may fall to the least. Radians a metre for the yaw.
const Eigen::Vector3d kLeastOfOthers(0.5, 0.5, 0.25);
// Links that are probed together are so many apart: what is left of their errors is nearly
// independent.
constexpr std::size_t kProbes = 12;

// Signs of links probed together, without a pattern that repeats (Thue and Morse).
double SignOf(std::size_t i) { return std::popcount(i) % 2 == 0 ? 1.0 : -1.0; }

}  // namespace

Eigen::Vector3d ShareSeen(const std::vector<GroupLink>& motions,
                          const std::vector<Pose2>& map_from_group, const PoseMatrix& factored) {
  if (motions.empty()) return Eigen::Vector3d::Ones();
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t begin = 0; begin < std::min(kProbes, motions.size()); ++begin) {
      Eigen::VectorXd probe = Eigen::VectorXd::Zero(factored.size());
      for (std::size_t i = begin; i < motions.size(); i += kProbes) {
        const GroupLink& link = motions[i];
        const double unit = SignOf(i / kProbes) / link.sigma[axis];
        probe.segment<3>(3 * link.first) +=
            unit * ErrorByFirst(link, map_from_group).row(axis).transpose();
        probe[3 * link.second + axis] += unit;
      }
      left[axis] += probe.dot(factored.Solve(probe));
    }
  }
  const Eigen::Vector3d share =
      Eigen::Vector3d::Ones() - left / static_cast<double>(motions.size());
  return share.cwiseMax(0.0).cwiseMin(1.0);
}

Eigen::Vector3d MotionSigma(const std::vector<GroupLink>& unit,
                            const std::vector<Pose2>& map_from_group,
                            const Eigen::Vector3d& share_seen) {
  if (unit.empty()) return kLeastMotionSigma;
  Eigen::Vector3d sigma;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> errors;
    for (const GroupLink& link : unit) {
      errors.push_back(std::abs(LinkError(link, map_from_group)[axis] / link.sigma[axis]));
    }
    // Below the least share the prior is taken for a little better each time, down to the least
    // sigma if it is perfect (measured in docs/math.md).
    const double share = std::max(share_seen[axis], kLeastShareSeen);
    sigma[axis] = kSigmaOfMedian * UpperMedian(std::move(errors)) / std::sqrt(share);
  }
  const double most = sigma.head<2>().maxCoeff();
  return sigma.cwiseMax(most * kLeastOfOthers).cwiseMax(kLeastMotionSigma);
}

}  // namespace depthgrid
