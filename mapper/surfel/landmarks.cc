#include "mapper/surfel/landmarks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "mapper/core/median.h"
#include "mapper/surfel/misfit.h"
#include "mapper/surfel/shared_errors.h"

namespace depthgrid {
namespace {

// Prior weight, in sightings, of a landmark being as good as most (1 to 12 make no difference:
// docs/tried.md, "Real SLAM's poses").
constexpr double kSightingsLikeMost = 4.0;
// Ten sigmas: limits the effect of one wrong association.
constexpr double kMostChi2 = 100.0;

}  // namespace

Landmarks::Landmarks(const std::vector<SurfelGroup>& groups,
                     const std::vector<Pose2>& map_from_group, const AssociationGate& gate)
    : groups_(groups) {
  std::vector<Sighting> in_time;
  std::vector<int> companies;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Motion2 motion(map_from_group[g]);
    const std::vector<Surfel>& surfels = groups[g].surfels;
    CountCompanions(surfels, companies);
    for (std::size_t i = 0; i < surfels.size(); ++i) {
      const int landmark = store_.Merge(motion * surfels[i], gate);
      in_time.push_back({landmark, static_cast<int>(g), companies[i], &surfels[i]});
    }
  }
  // Counting sort by landmark; within one they stay in order of time.
  begin_.assign(static_cast<std::size_t>(store_.size()) + 1, 0);
  for (const Sighting& s : in_time) ++begin_[static_cast<std::size_t>(s.landmark) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  sightings_.resize(in_time.size());
  for (const Sighting& s : in_time) sightings_[next[static_cast<std::size_t>(s.landmark)]++] = s;
}

void Landmarks::ExtendEnvelope(std::vector<int>& first) const {
  for (std::size_t landmark = 0; landmark + 1 < begin_.size(); ++landmark) {
    const int earliest = sightings_[begin_[landmark]].group;
    for (std::size_t i = begin_[landmark]; i < begin_[landmark + 1]; ++i) {
      int& place = first[static_cast<std::size_t>(sightings_[i].group)];
      place = std::min(place, earliest);
    }
  }
}

Landmarks::Row Landmarks::RowOf(const Sighting& sighting, const Motion2& motion,
                                const SightingTrust& trust) const {
  const Surfel& landmark = store_[sighting.landmark];
  const Surfel& local = *sighting.surfel;
  Row row;
  row.group = sighting.group;
  row.error_m = OffsetFrom(landmark, motion * local.point_m);
  const double shared = CountedOver(sighting.company, trust.errors.correlation);
  row.information = local.information / (trust.errors.variance_factor * shared);
  const double sigmas = std::abs(row.error_m) * std::sqrt(row.information);
  row.weight = row.information * std::min(1.0, trust.huber_sigmas / sigmas);
  // Applied after Huber's rule, so that a bad landmark counts less than its residuals alone imply.
  if (!trust.landmark_factor.empty()) {
    row.weight /= trust.landmark_factor[static_cast<std::size_t>(sighting.landmark)];
  }
  // The wall that the group saw is taken where it passes the landmark. Were it the sighting's own
  // point, an error of the landmark's normal would turn all groups at once.
  row.jacobian = OffsetJacobian(motion.TurnBack(landmark.normal),
                                motion.TurnBack(landmark.point_m - motion.shift_m));
  return row;
}

void Landmarks::FindRows(std::size_t landmark, const std::vector<Motion2>& motions,
                         const SightingTrust& trust, Rows& found) const {
  found.rows.clear();
  found.weights = 0.0;
  double weighted_error = 0.0;
  for (std::size_t i = begin_[landmark]; i < begin_[landmark + 1]; ++i) {
    const auto group = static_cast<std::size_t>(sightings_[i].group);
    const Row& row = found.rows.emplace_back(RowOf(sightings_[i], motions[group], trust));
    found.weights += row.weight;
    weighted_error += row.weight * row.error_m;
  }
  found.offset_m = weighted_error / found.weights;
}

SightingErrors Landmarks::ErrorsAt(const std::vector<Pose2>& map_from_group) const {
  const std::vector<Motion2> motions(map_from_group.begin(), map_from_group.end());
  const SightingTrust as_claimed{std::numeric_limits<double>::infinity(), {}};
  Misfit misfit;
  std::vector<std::vector<double>> residuals;  // in sigmas, by group and surfel
  for (const SurfelGroup& group : groups_) residuals.emplace_back(group.surfels.size());
  Rows found;
  for (std::size_t landmark = 0; landmark + 1 < begin_.size(); ++landmark) {
    if (SeenByOneGroup(landmark)) continue;
    FindRows(landmark, motions, as_claimed, found);
    const Sighting* sighting = &sightings_[begin_[landmark]];
    for (const Row& row : found.rows) {
      const auto group = static_cast<std::size_t>(row.group);
      const auto place = (sighting++)->surfel - groups_[group].surfels.data();
      // The mean contains the sighting, so the residual's variance is less than the sighting's.
      const double variance = 1.0 / row.weight - 1.0 / found.weights;
      if (variance <= 0.0) continue;
      const double sigmas = (row.error_m - found.offset_m) / std::sqrt(variance);
      misfit.Add(sigmas);
      residuals[group][static_cast<std::size_t>(place)] = sigmas;
    }
  }
  SharedErrors shared;
  for (std::size_t g = 0; g < groups_.size(); ++g) shared.Add(groups_[g].surfels, residuals[g]);
  return {misfit.VarianceFactor(), shared.Correlation()};
}

std::vector<double> Landmarks::FactorsAt(const std::vector<Pose2>& map_from_group,
                                         const SightingTrust& trust) const {
  const std::vector<Motion2> motions(map_from_group.begin(), map_from_group.end());
  std::vector<double> factors(begin_.size() - 1, 1.0);
  std::vector<double> seen;
  Rows found;
  for (std::size_t landmark = 0; landmark < factors.size(); ++landmark) {
    if (SeenByOneGroup(landmark)) continue;
    FindRows(landmark, motions, trust, found);
    double chi2 = kSightingsLikeMost;
    for (const Row& row : found.rows) {
      const double off_m = row.error_m - found.offset_m;
      chi2 += std::min(off_m * off_m * row.information, kMostChi2);
    }
    // Minus one: the offset was fitted.
    factors[landmark] = chi2 / (kSightingsLikeMost + static_cast<double>(found.rows.size()) - 1.0);
    seen.push_back(factors[landmark]);
  }
  if (seen.empty()) return factors;
  const double most = std::max(1.0, UpperMedian(std::move(seen)));
  for (double& factor : factors) factor = std::max(1.0, factor / most);
  return factors;
}

void Landmarks::AddTo(const std::vector<Pose2>& map_from_group, const SightingTrust& trust,
                      PoseMatrix& h, Eigen::VectorXd& g) const {
  const std::vector<Motion2> motions(map_from_group.begin(), map_from_group.end());
  Rows found;
  std::vector<PoseShare> sums;
  for (std::size_t landmark = 0; landmark + 1 < begin_.size(); ++landmark) {
    if (SeenByOneGroup(landmark)) continue;  // does not constrain poses
    FindRows(landmark, motions, trust, found);
    // Sightings by the same group come one after the other: one sum of rows each.
    sums.clear();
    for (const Row& row : found.rows) {
      const Eigen::Vector3d weighted_row = row.weight * row.jacobian;
      g.segment<3>(3 * row.group) -= (row.error_m - found.offset_m) * weighted_row;
      h.AddBlock(row.group, row.group, weighted_row * row.jacobian.transpose());
      if (sums.empty() || sums.back().pose != row.group) sums.push_back({row.group});
      sums.back().share += weighted_row;
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const Eigen::Vector3d scaled = -sums[k].share / found.weights;
      h.AddProducts(sums[k].pose, scaled, std::span(sums).first(k));
      h.AddBlock(sums[k].pose, sums[k].pose, scaled * sums[k].share.transpose());
    }
  }
}

}  // namespace depthgrid
