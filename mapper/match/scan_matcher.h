// Matches a scan to a submap: correlative search, then bicubic least squares (Eq. 4), then the
// covariance.
#pragma once

#include "mapper/core/frame_report.h"
#include "mapper/core/options.h"
#include "mapper/match/correlative_search.h"
#include "mapper/match/least_squares.h"
#include "mapper/match/match_information.h"
#include "mapper/match/score_surface.h"

namespace depthgrid {

enum class MatchStages { kBoth, kSearch, kLeastSquares };

struct ScanMatcherOptions {
  MatchStages stages = MatchStages::kBoth;
  // Probability of never-seen cells; 0.5 is neutral.
  double unknown_prob = 0.5;
  // Scans with fewer hits are not matched.
  int min_points = 20;
  // A match is found when at least this share of its points lies where the map is occupied. Low on
  // purpose: rejecting doubtful matches keeps a wrong prediction wrong.
  double min_score = 0.2;
  // Directions with a larger standard deviation count as undetermined: a fixed gain would otherwise
  // follow a guess of 5 cm at a corner just coming into view. 3 cm loses 7 %, 2 cm 16 % of the
  // accuracy with poses that drift (docs/tried.md).
  double max_sigma_m = 0.04;
  CorrelativeOptions search;
  LeastSquaresOptions least_squares;
  MatchInformationOptions information;

  void Visit(OptionsVisitor& v);
};

class ScanMatcher {
 public:
  explicit ScanMatcher(const ScanMatcherOptions& options);

  // Never throws for any scan or prediction; without a match `found` is false and the pose is the
  // prediction.
  MatchResult Match(const Scan& scan, const ProbabilityView& view,
                    const Pose2& predicted_map_from_base);

 private:
  Eigen::Matrix3d InformationAt(const Pose2& map_from_base, const ProbabilityView& map,
                                const InformationSums& sums);

  ScanMatcherOptions options_;
  CorrelativeSearch search_;
  MatchPoints points_;  // this and the following are members to reuse their memory
  FastMatchCost cost_;
  LatticeScorer scorer_;
  ScoreSurface surface_;
};

}  // namespace depthgrid
