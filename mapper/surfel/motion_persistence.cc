#include "mapper/surfel/motion_persistence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "mapper/surfel/motion_sigma.h"
#include "mapper/surfel/sign_correlation.h"

namespace depthgrid {
namespace {

// Neighbouring errors share the pose between them, with opposite signs; links so far apart share
// none.
constexpr std::size_t kLag = 4;
constexpr int kMinLinkPairs = 20;
// With 1, errors would be a random walk without bounds.
constexpr double kMostPersistence = 0.97;

constexpr int kForward = 0;

bool Follows(const GroupLink& link, const GroupLink& before) { return link.first == before.second; }

// Whether the links up to `last` follow each other from `kLag` before it.
bool IsUnbroken(const std::vector<GroupLink>& links, std::size_t last) {
  for (std::size_t i = last - kLag + 1; i <= last; ++i) {
    if (!Follows(links[i], links[i - 1])) return false;
  }
  return true;
}

// Share of the previous error, in sigmas of each, that goes on in motion `i`. Where sigma has grown
// since, the same error is fewer sigmas.
Eigen::Vector3d GoingOn(std::size_t i, const Eigen::Vector3d& persistence,
                        const std::vector<Eigen::Vector3d>& growth) {
  if (growth.empty()) return persistence;
  return persistence.cwiseProduct(growth[i - 1].cwiseQuotient(growth[i]).cwiseMin(1.0));
}

// Adds the innovation: the error of `link` minus `going_on` times that of `before`, with its
// derivatives by the three poses.
void AddFollowing(const GroupLink& before, const GroupLink& link,
                  const Eigen::Vector3d& persistence, const Eigen::Vector3d& going_on,
                  const std::vector<Pose2>& map_from_group, PoseMatrix& h, Eigen::VectorXd& g) {
  const Eigen::Vector3d renewed = (1.0 - persistence.array().square()).sqrt().matrix();
  const Eigen::Vector3d by_link = renewed.cwiseProduct(link.sigma).cwiseInverse();
  const Eigen::Vector3d by_before = -going_on.cwiseQuotient(renewed.cwiseProduct(before.sigma));
  const Eigen::Vector3d error = by_link.cwiseProduct(LinkError(link, map_from_group)) +
                                by_before.cwiseProduct(LinkError(before, map_from_group));
  const std::array<int, 3> poses = {before.first, link.first, link.second};
  std::array<Eigen::Matrix3d, 3> jacobian;
  jacobian[0] = by_before.asDiagonal() * ErrorByFirst(before, map_from_group);
  jacobian[1] = by_link.asDiagonal() * ErrorByFirst(link, map_from_group);
  jacobian[1].diagonal() += by_before;
  jacobian[2] = by_link.asDiagonal();
  for (std::size_t row = 0; row < poses.size(); ++row) {
    g.segment<3>(3 * poses[row]) -= jacobian[row].transpose() * error;
    for (std::size_t column = 0; column <= row; ++column) {
      h.AddBlock(poses[row], poses[column], jacobian[row].transpose() * jacobian[column]);
    }
  }
}

// `agreement`: number of pairs with equal signs minus number with opposite signs.
double PersistenceOf(double agreement, double pairs) {
  // Minus one standard error: the fourth root amplifies chance agreement of independent errors.
  const double surely = agreement / pairs - 1.0 / std::sqrt(pairs);
  if (surely <= 0.0) return 0.0;
  const double kept = std::pow(CorrelationOfSigns(surely), 1.0 / static_cast<double>(kLag));
  return std::min(kept, kMostPersistence);
}

}  // namespace

Eigen::Vector3d MotionPersistence(const std::vector<GroupLink>& unit,
                                  const std::vector<Pose2>& map_from_group,
                                  const std::vector<Eigen::Vector3d>& shares_seen) {
  if (MeanShare(shares_seen)[kForward] < kLeastShareSeen) return Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> errors;
  for (const GroupLink& link : unit) errors.push_back(LinkError(link, map_from_group));
  Eigen::Vector3d pairs = Eigen::Vector3d::Zero();
  Eigen::Vector3d agreement = Eigen::Vector3d::Zero();
  for (std::size_t i = kLag; i < unit.size(); ++i) {
    if (!IsUnbroken(unit, i)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::min(shares_seen[i][axis], shares_seen[i - kLag][axis]) < kLeastShareSeen) continue;
      pairs[axis] += 1.0;
      const double product = errors[i][axis] * errors[i - kLag][axis];
      agreement[axis] += product > 0.0 ? 1.0 : (product < 0.0 ? -1.0 : 0.0);
    }
  }
  if (pairs.maxCoeff() < kMinLinkPairs) return Eigen::Vector3d::Zero();
  std::array<std::optional<double>, 3> told;
  double least = kMostPersistence;
  for (int axis = 0; axis < 3; ++axis) {
    if (pairs[axis] < kMinLinkPairs) continue;
    const double lasts = PersistenceOf(agreement[axis], pairs[axis]);
    told[static_cast<std::size_t>(axis)] = lasts;
    least = std::min(least, lasts);
  }
  return {told[0].value_or(least), told[1].value_or(least), told[2].value_or(least)};
}

void AddMotions(const std::vector<GroupLink>& motions, const Eigen::Vector3d& persistence,
                const std::vector<Eigen::Vector3d>& growth,
                const std::vector<Pose2>& map_from_group, PoseMatrix& h, Eigen::VectorXd& g) {
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (i > 0 && Follows(motions[i], motions[i - 1]) && !persistence.isZero(0.0)) {
      AddFollowing(motions[i - 1], motions[i], persistence, GoingOn(i, persistence, growth),
                   map_from_group, h, g);
    } else {
      AddLink(motions[i], map_from_group, h, g);
    }
  }
}

}  // namespace depthgrid
