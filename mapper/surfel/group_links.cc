#include "mapper/surfel/group_links.h"

#include "mapper/fuse/fusion.h"

namespace depthgrid {
namespace {

Pose2 RelativePose(const GroupLink& link, const std::vector<Pose2>& map_from_group) {
  return Between(map_from_group[static_cast<std::size_t>(link.first)],
                 map_from_group[static_cast<std::size_t>(link.second)]);
}

double WeightOf(const GroupLink& link, double sigmas) {
  const double huber = link.huber_sigmas;
  const double cauchy = link.cauchy_sigmas;
  double weight = 1.0;
  if (huber > 0.0 && sigmas > huber) weight *= huber / sigmas;
  if (cauchy > 0.0) weight /= 1.0 + sigmas * sigmas / (cauchy * cauchy);
  return weight;
}

}  // namespace

Eigen::Vector3d LinkError(const GroupLink& link, const std::vector<Pose2>& map_from_group) {
  return Between(link.first_from_second, RelativePose(link, map_from_group)).vector();
}

double LinkSigmas(const GroupLink& link, const std::vector<Pose2>& map_from_group) {
  return LinkError(link, map_from_group).cwiseQuotient(link.sigma).norm();
}

// A small motion d of `first` changes first_from_second by -AdjointOf(second_from_first) d.
Eigen::Matrix3d ErrorByFirst(const GroupLink& link, const std::vector<Pose2>& map_from_group) {
  return -AdjointOf(Inverse(RelativePose(link, map_from_group)));
}

void AddLink(const GroupLink& link, const std::vector<Pose2>& map_from_group, PoseMatrix& h,
             Eigen::VectorXd& g) {
  const Eigen::Vector3d error = LinkError(link, map_from_group);
  const Eigen::Vector3d weight = WeightOf(link, LinkSigmas(link, map_from_group)) *
                                 link.sigma.cwiseProduct(link.sigma).cwiseInverse();
  const Eigen::Matrix3d by_first = ErrorByFirst(link, map_from_group);
  const Eigen::Matrix3d weighted = weight.asDiagonal() * by_first;
  const Eigen::Matrix3d first_block = by_first.transpose() * weighted;
  h.AddBlock(link.first, link.first, first_block);
  if (link.first < link.second) {
    h.AddBlock(link.second, link.first, weighted);
  } else {
    h.AddBlock(link.first, link.second, weighted.transpose());
  }
  h.AddBlock(link.second, link.second, weight.asDiagonal().toDenseMatrix());
  g.segment<3>(3 * link.first) -= weighted.transpose() * error;
  g.segment<3>(3 * link.second) -= weight.cwiseProduct(error);
}

}  // namespace depthgrid
