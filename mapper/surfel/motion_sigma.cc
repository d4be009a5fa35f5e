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
// Nor is it along one axis so much better than along the others: in a corridor nothing tells how it
// errs lengthways, before one wall of a hall only the yaw is seen, and an axis' sigma may fall to
// the least. Radians a metre for the yaw; in comparing, a radian of it counts as a metre.
const Eigen::Vector3d kLeastOfOthers(0.5, 0.5, 0.25);
constexpr double kMetresARadian = 1.0;
// Links that are probed together are so many apart: what is left of their errors is nearly
// independent.
constexpr std::size_t kProbes = 12;

Eigen::Index ProbeOf(std::size_t link) { return static_cast<Eigen::Index>(link % kProbes); }

// Motions of which this share was seen count as much as any: where the prior is nearly perfect
// little is seen beside it, and of all motions alike.
constexpr double kWhollyCounted = 0.1;

// Links probed together have signs without a pattern that repeats (Thue and Morse).
double SignOf(std::size_t link) { return std::popcount(link / kProbes) % 2 == 0 ? 1.0 : -1.0; }

// How an axis of the link's error, over its sigma, changes with small motions of its two groups.
struct ErrorRow {
  Eigen::RowVector3d by_first;
  Eigen::RowVector3d by_second;
};
ErrorRow RowOf(const GroupLink& link, int axis, const std::vector<Pose2>& map_from_group) {
  return {ErrorByFirst(link, map_from_group).row(axis) / link.sigma[axis],
          Eigen::RowVector3d::Unit(axis) / link.sigma[axis]};
}

// So many motions on either side of one are near it. Of so many they must count for: a few that
// were seen among others that were not tell of themselves.
constexpr std::size_t kNear = 5;
constexpr double kLeastNear = 6.0;
// They err by more than all if by so much: medians of so few differ by a third by chance, and where
// SLAM's error is a slowly varying bias neighbours are all as large.
constexpr double kLeastGrowth = 5.0;

// The sigma of errors of which this share was seen. Each of weight by its share.
class ErrorSpread {
 public:
  void Add(double error, double share) {
    const double weight = std::min(share / kWhollyCounted, 1.0);
    errors_.push_back({std::abs(error), weight});
    weights_ += weight;
    squares_ += weight * weight;
    seen_ += weight * share;
  }
  // How many errors of equal weight would tell as much (Kish 1965, "Survey Sampling").
  double Count() const { return squares_ > 0.0 ? weights_ * weights_ / squares_ : 0.0; }
  double Sigma(double least_share) && {
    const double share = std::max(weights_ > 0.0 ? seen_ / weights_ : 0.0, least_share);
    return kSigmaOfMedian * WeighedMedian(std::move(errors_)) / std::sqrt(share);
  }

 private:
  std::vector<Weighed> errors_;
  double weights_ = 0.0;
  double squares_ = 0.0;
  double seen_ = 0.0;
};

}  // namespace

std::vector<Eigen::Vector3d> SharesSeen(const std::vector<GroupLink>& motions,
                                        const std::vector<Pose2>& map_from_group,
                                        const PoseMatrix& factored) {
  std::vector<Eigen::Vector3d> shares(motions.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<ErrorRow> rows;
    for (const GroupLink& link : motions) rows.push_back(RowOf(link, axis, map_from_group));
    Eigen::MatrixXd probes = Eigen::MatrixXd::Zero(factored.size(), kProbes);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      auto probe = probes.col(ProbeOf(i));
      probe.segment<3>(3 * motions[i].first) += SignOf(i) * rows[i].by_first.transpose();
      probe.segment<3>(3 * motions[i].second) += SignOf(i) * rows[i].by_second.transpose();
    }
    const Eigen::MatrixXd solved = factored.SolveAll(probes);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const auto answer = solved.col(ProbeOf(i));
      const double left =
          SignOf(i) * (rows[i].by_first.dot(answer.segment<3>(3 * motions[i].first)) +
                       rows[i].by_second.dot(answer.segment<3>(3 * motions[i].second)));
      shares[i][axis] = std::clamp(1.0 - left, 0.0, 1.0);
    }
  }
  return shares;
}

Eigen::Vector3d MeanShare(const std::vector<Eigen::Vector3d>& shares) {
  if (shares.empty()) return Eigen::Vector3d::Ones();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& share : shares) sum += share;
  return sum / static_cast<double>(shares.size());
}

Eigen::Vector3d SeenSigma(const Eigen::Vector3d& sigma,
                          const std::vector<Eigen::Vector3d>& shares) {
  const Eigen::Array3d share = MeanShare(shares);
  return sigma.array() / share.sqrt();
}

Eigen::Vector3d MotionSigma(const std::vector<GroupLink>& unit,
                            const std::vector<Pose2>& map_from_group,
                            const std::vector<Eigen::Vector3d>& shares_seen) {
  if (unit.empty()) return kLeastMotionSigma;
  Eigen::Vector3d sigma;
  for (int axis = 0; axis < 3; ++axis) {
    ErrorSpread spread;
    for (std::size_t i = 0; i < unit.size(); ++i) {
      const double error = LinkError(unit[i], map_from_group)[axis] / unit[i].sigma[axis];
      spread.Add(error, shares_seen[i][axis]);
    }
    // Below the least share the prior is taken for a little better each time, down to the least
    // sigma if it is perfect (docs/tried.md, "A nearly perfect prior").
    sigma[axis] = std::move(spread).Sigma(kLeastShareSeen);
  }
  const double most = std::max(sigma.head<2>().maxCoeff(), kMetresARadian * sigma.z());
  return sigma.cwiseMax(most * kLeastOfOthers).cwiseMax(kLeastMotionSigma);
}

std::vector<Eigen::Vector3d> MotionGrowth(const std::vector<GroupLink>& unit,
                                          const std::vector<GroupLink>& believed,
                                          const std::vector<Pose2>& map_from_group,
                                          const std::vector<Eigen::Vector3d>& shares_seen,
                                          const Eigen::Vector3d& sigma) {
  std::vector<Eigen::Vector3d> growth(unit.size(), Eigen::Vector3d::Ones());
  std::vector<Eigen::Vector3d> errors;
  for (const GroupLink& link : believed) {
    errors.push_back(LinkError(link, map_from_group).cwiseQuotient(link.sigma));
  }
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::size_t end = std::min(i + kNear + 1, unit.size());
    for (int axis = 0; axis < 3; ++axis) {
      ErrorSpread spread;
      for (std::size_t j = i - std::min(i, kNear); j < end; ++j) {
        spread.Add(errors[j][axis], shares_seen[j][axis]);
      }
      if (spread.Count() <= kLeastNear) continue;
      // The errors' size over what it was believed to be.
      const double ratio = std::move(spread).Sigma(kWhollyCounted);
      const double times = ratio * believed[i].sigma[axis] / (unit[i].sigma[axis] * sigma[axis]);
      if (ratio > 1.0 && times > kLeastGrowth) growth[i][axis] = times;
    }
  }
  return growth;
}

}  // namespace depthgrid
