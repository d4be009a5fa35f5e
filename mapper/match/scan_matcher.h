// Scan to submap: correlative search, then bicubic least squares (Eq. 4), then how well the scan
// determines the pose.
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
  // What never-seen cells count. 0.5 is indifferent.
  double unknown_prob = 0.5;
  // Fewer hits than this are no scan to match.
  int min_points = 20;
  // A match is found when at least this share of its points lies where the map is occupied. Low on
  // purpose: a gate that refuses doubtful matches locks onto a wrong prediction.
  double min_score = 0.2;
  // A direction that the match knows worse than this counts as not determined: a fixed gain would
  // take a guess of 5 cm at a corner that only just came into view. 3 cm loses 7 %, 2 cm 16 % of
  // the accuracy with poses that drift (docs/tried.md).
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
  MatchPoints points_;  // all of these are kept for their memory
  FastMatchCost cost_;
  LatticeScorer scorer_;
  ScoreSurface surface_;
};

}  // namespace depthgrid
