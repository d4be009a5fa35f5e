#include "mapper/surfel/motion_sigma.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "mapper/core/median.h"

namespace depthgrid {
namespace {

// Least sigma per frame: simulated SLAM can be perfect.
const Eigen::Vector3d kLeastMotionSigma(1e-5, 1e-5, 2e-6);
// Least sigma of an axis as a share of the largest one: in a corridor the error lengthways is
// unobserved, before one wall of a hall only yaw is observed, and an unobserved axis' sigma would
// fall to the least. For yaw in rad/m; to find the largest, a radian counts as a metre.
const Eigen::Vector3d kLeastOfOthers(0.5, 0.5, 0.25);
constexpr double kMetresARadian = 1.0;
// Links in the same probe are this many apart, so that their errors are nearly independent.
constexpr std::size_t kProbes = 12;

Eigen::Index ProbeOf(std::size_t link) { return static_cast<Eigen::Index>(link % kProbes); }

// Share observed from which a motion has full weight. Low, because beside nearly perfect SLAM the
// share of sightings is small for all motions.
constexpr double kWhollyCounted = 0.1;

// Signs of the links in a probe: the aperiodic Thue-Morse sequence.
double SignOf(std::size_t link) { return std::popcount(link / kProbes) % 2 == 0 ? 1.0 : -1.0; }

// Derivative of one axis of a link's error / sigma by small motions of its two groups.
struct ErrorRow {
  Eigen::RowVector3d by_first;
  Eigen::RowVector3d by_second;
};
ErrorRow RowOf(const GroupLink& link, int axis, const std::vector<Pose2>& map_from_group) {
  return {ErrorByFirst(link, map_from_group).row(axis) / link.sigma[axis],
          Eigen::RowVector3d::Unit(axis) / link.sigma[axis]};
}

// Motions on either side that are averaged, and the least effective number of them: a few observed
// ones among unobserved ones represent only themselves.
constexpr std::size_t kNear = 5;
constexpr double kLeastNear = 6.0;
// Least growth that is used: medians of so few differ by a third by chance, and a slowly varying
// bias is large for all neighbours at once.
constexpr double kLeastGrowth = 5.0;

double MotionWeight(double share) { return std::min(share / kWhollyCounted, 1.0); }

// Sigma of errors that are weighted by the share of each that was observed.
class ErrorSpread {
 public:
  void Add(double error, double share) {
    const double weight = MotionWeight(share);
    errors_.push_back({std::abs(error), weight});
    weights_ += weight;
    seen_ += weight * share;
  }
  double Sigma(double least_share) && {
    const double share = std::max(weights_ > 0.0 ? seen_ / weights_ : 0.0, least_share);
    return kSigmaOfMedian * WeighedMedian(std::move(errors_)) / std::sqrt(share);
  }

 private:
  std::vector<Weighed> errors_;
  double weights_ = 0.0;
  double seen_ = 0.0;
};

// What the motions around one tell of SLAM's sigma there. Each tells it by its own residual and
// share: some may be believed far less than others, and so have followed the sightings farther.
class NearbySigma {
 public:
  // `error`: residual over the sigma that was believed; `believed`: that sigma over the common one.
  void Add(double error, double share, double believed) {
    const double weight = MotionWeight(share);
    const double sigma = std::abs(error) / std::sqrt(std::max(share, kWhollyCounted));
    over_believed_.push_back({sigma, weight});
    over_common_.push_back({sigma * believed, weight});
    weights_ += weight;
    squares_ += weight * weight;
  }
  // Effective number of motions (Kish 1965, "Survey Sampling").
  double Count() const { return squares_ > 0.0 ? weights_ * weights_ / squares_ : 0.0; }
  double OverBelieved() const { return kSigmaOfMedian * WeighedMedian(over_believed_); }
  double OverCommon() const { return kSigmaOfMedian * WeighedMedian(over_common_); }

 private:
  std::vector<Weighed> over_believed_;
  std::vector<Weighed> over_common_;
  double weights_ = 0.0;
  double squares_ = 0.0;
};

// Of a stretch. A sigma that has grown may also shrink: once it is right, the errors are as large
// as believed.
double GrowthOf(const NearbySigma& nearby, bool was_grown) {
  if (nearby.Count() <= kLeastNear) return 1.0;
  const double times = nearby.OverCommon();
  return (nearby.OverBelieved() > 1.0 || was_grown) && times > kLeastGrowth ? times : 1.0;
}

// Of one motion that may err alone, as where a wheel slips. All in common sigmas; `error`:
// residual, `believed`: the sigma with which it was solved. What was seen differs from the motion
// by error / share, and its own variance follows from the share.
double GrowthAlone(double error, double share, double believed) {
  if (share < kLeastShareSeen) return 1.0;
  const double difference = error / share;
  const double seen_variance = believed * believed * (1.0 / share - 1.0);
  const double square = difference * difference;
  if (square <= kLeastGrowth * kLeastGrowth * (1.0 + seen_variance)) return 1.0;
  return std::sqrt(square - seen_variance);
}

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
    // Below the least share sigma falls a little in each round, down to the least sigma if SLAM is
    // perfect (docs/tried.md, "A nearly perfect prior").
    sigma[axis] = std::move(spread).Sigma(kLeastShareSeen);
  }
  const double most = std::max(sigma.head<2>().maxCoeff(), kMetresARadian * sigma.z());
  return sigma.cwiseMax(most * kLeastOfOthers).cwiseMax(kLeastMotionSigma);
}

std::vector<Eigen::Vector3d> MotionGrowth(const std::vector<GroupLink>& unit,
                                          const std::vector<GroupLink>& believed,
                                          const std::vector<Pose2>& map_from_group,
                                          const std::vector<Eigen::Vector3d>& shares_seen,
                                          const Eigen::Vector3d& sigma,
                                          const std::vector<Eigen::Vector3d>& before) {
  std::vector<Eigen::Vector3d> growth(unit.size(), Eigen::Vector3d::Ones());
  std::vector<Eigen::Vector3d> errors;
  std::vector<Eigen::Vector3d> grown;  // believed sigma over the common one
  for (std::size_t i = 0; i < unit.size(); ++i) {
    errors.push_back(LinkError(believed[i], map_from_group).cwiseQuotient(believed[i].sigma));
    grown.push_back(believed[i].sigma.cwiseQuotient(unit[i].sigma.cwiseProduct(sigma)));
  }
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::size_t end = std::min(i + kNear + 1, unit.size());
    for (int axis = 0; axis < 3; ++axis) {
      NearbySigma nearby;
      for (std::size_t j = i - std::min(i, kNear); j < end; ++j) {
        nearby.Add(errors[j][axis], shares_seen[j][axis], grown[j][axis]);
      }
      const bool was_grown = !before.empty() && before[i][axis] > 1.0;
      growth[i][axis] = GrowthOf(nearby, was_grown);
      if (before.empty()) continue;  // the shares are not known yet
      const double alone =
          GrowthAlone(errors[i][axis] * grown[i][axis], shares_seen[i][axis], grown[i][axis]);
      growth[i][axis] = std::max(growth[i][axis], alone);
    }
  }
  return growth;
}

}  // namespace depthgrid
