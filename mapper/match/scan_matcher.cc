#include "mapper/match/scan_matcher.h"

#include <cmath>

#include "mapper/match/bicubic.h"

namespace depthgrid {
namespace {

// False for NaN too. The limit keeps cell indices within int.
bool IsUsable(const Pose2& pose) {
  constexpr double kFarthestM = 1e6;
  return std::abs(pose.x_m) < kFarthestM && std::abs(pose.y_m) < kFarthestM &&
         std::isfinite(pose.yaw_rad);
}

// Share of the points that lie where the map is rather occupied than free.
double ExplainedShare(const MatchPoints& points, const ProbabilityView& view,
                      const Pose2& map_from_base) {
  constexpr double kOccupied = 0.525;  // half of what one hit (0.55) adds to knowing nothing
  int explained = 0;
  for (std::size_t i = 0; i < points.x_m.size(); ++i) {
    const Eigen::Vector2d point{points.x_m[i], points.y_m[i]};
    if (SampleBicubic(view, map_from_base * point).value > kOccupied) ++explained;
  }
  return static_cast<double>(explained) / points.size();
}

}  // namespace

void ScanMatcherOptions::Visit(OptionsVisitor& v) {
  v.Choice("stages", stages,
           {{MatchStages::kBoth, "both"},
            {MatchStages::kSearch, "search"},
            {MatchStages::kLeastSquares, "least_squares"}},
           "correlative search, least squares, or the one after the other");
  v.Number("unknown_prob", unknown_prob, {0.0, 1.0}, "what never-seen cells count");
  v.Number("min_points", min_points, {3, 100000}, "fewest hits that are matched");
  v.Number("min_score", min_score, {0.0, 1.0}, "least share of explained hits of a match");
  v.Group("search", search, "correlative search");
  v.Group("least_squares", least_squares, "bicubic least squares, Eq. 4");
  v.Group("information", information, "covariance of a match");
}

ScanMatcher::ScanMatcher(const ScanMatcherOptions& options)
    : options_(options), search_(options.search), least_squares_(options.least_squares) {}

MatchResult ScanMatcher::Match(const Scan& scan, const ProbabilityView& view,
                               const Pose2& predicted_map_from_base) {
  MatchResult result;
  result.map_from_base = predicted_map_from_base;
  points_.Assign(scan);
  if (points_.size() < options_.min_points || !IsUsable(predicted_map_from_base)) return result;
  ProbabilityView map = view;
  map.unknown_prob = static_cast<float>(options_.unknown_prob);

  Pose2 pose = predicted_map_from_base;
  if (options_.stages != MatchStages::kLeastSquares) {
    pose = search_.Search(points_, map, pose).map_from_base;
  }
  if (options_.stages != MatchStages::kSearch) {
    const LeastSquaresMatch refined =
        least_squares_.Solve(points_, map, pose, predicted_map_from_base);
    pose = refined.map_from_base;
    result.iterations = refined.iterations;
  }
  result.score = ExplainedShare(points_, map, pose);
  result.found = result.score >= options_.min_score;
  if (!result.found) return result;
  result.map_from_base = pose;
  result.information = MatchInformation(points_, map, pose, options_.information);
  return result;
}

}  // namespace depthgrid
