#include "mapper/match/scan_matcher.h"

#include "mapper/core/frame.h"

namespace depthgrid {
void ScanMatcherOptions::Visit(OptionsVisitor& v) {
  v.Choice("stages", stages,
           {{MatchStages::kBoth, "both"},
            {MatchStages::kSearch, "search"},
            {MatchStages::kLeastSquares, "least_squares"}},
           "correlative search, least squares, or both, one after the other");
  v.Number("unknown_prob", unknown_prob, {0.0, 1.0}, "probability that unseen cells count as");
  v.Number("min_points", min_points, {3, 100000}, "fewest hits that are matched");
  v.Number("min_score", min_score, {0.0, 1.0}, "least share of explained hits of a match");
  v.Number("max_sigma_m", max_sigma_m, {1e-4, 1e3},
           "a direction with a larger standard deviation counts as not determined");
  v.Group("search", search, "correlative search");
  v.Group("least_squares", least_squares, "bicubic least squares, Eq. 4");
  v.Group("information", information, "covariance of a match");
}

ScanMatcher::ScanMatcher(const ScanMatcherOptions& options)
    : options_(options), search_(options.search) {}

MatchResult ScanMatcher::Match(const Scan& scan, const ProbabilityView& view,
                               const Pose2& predicted_map_from_base) {
  MatchResult result;
  result.map_from_base = predicted_map_from_base;
  points_.Assign(scan);
  if (points_.size() < options_.min_points || !IsOnAMap(predicted_map_from_base)) return result;
  ProbabilityView map = view;
  map.unknown_prob = static_cast<float>(options_.unknown_prob);

  Pose2 seed = predicted_map_from_base;
  if (options_.stages != MatchStages::kLeastSquares) {
    seed = search_.Search(points_, map, predicted_map_from_base).map_from_base;
  }
  cost_.Prepare(points_, map, seed);
  Pose2 pose = seed;
  if (options_.stages != MatchStages::kSearch) {
    const LeastSquaresMatch refined =
        SolveLeastSquares(options_.least_squares, cost_, seed, predicted_map_from_base);
    pose = refined.map_from_base;
    result.iterations = refined.iterations;
  }
  const InformationSums sums = cost_.SumUp(pose, options_.information);
  result.score = static_cast<double>(sums.explained) / points_.size();
  result.information =
      WithoutWeakDirections(InformationAt(pose, map, sums), options_.max_sigma_m, cost_.arm_m());
  result.found = result.score >= options_.min_score && !result.information.isZero(0.0);
  if (!result.found) {
    result.information.setZero();
    return result;
  }
  result.map_from_base =
      WithUndeterminedFrom(predicted_map_from_base, pose, result.information, cost_.arm_m());
  return result;
}

Eigen::Matrix3d ScanMatcher::InformationAt(const Pose2& map_from_base, const ProbabilityView& map,
                                           const InformationSums& sums) {
  const MatchInformationOptions& options = options_.information;
  if (options.source == InformationSource::kCurvature) {
    return MatchInformation(sums, map_from_base, options);
  }
  const SearchLattice lattice =
      MakeLattice(map_from_base, options.surface_window_m, RadFromDeg(options.surface_window_deg),
                  map.geometry.resolution_m, points_.farthest_m);
  ScoreAll(lattice, points_, map, scorer_, surface_);
  return SurfaceInformation(surface_, options.surface_sharpness) / options.covariance_scale;
}

}  // namespace depthgrid
