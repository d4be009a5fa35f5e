// How well a scan determines its pose in a submap: the inverse covariance of a match.
#pragma once

#include "mapper/core/options.h"
#include "mapper/match/match_cost.h"

namespace depthgrid {

struct MatchInformationOptions {
  // Uncertainty of the direction of the map's walls as a matcher sees it, radians. Information that
  // walls could only give along themselves through such an error is taken away, so that a
  // corridor's axis stays undetermined. 0 takes away nothing.
  double wall_direction_sigma_rad = 0.05;
  // The covariance is multiplied by this: map errors are common to all beams and cannot be seen in
  // one scan.
  double covariance_scale = 1.0;

  void Visit(OptionsVisitor& v);
};

// Inverse covariance of map_from_base for a small motion (forward m, left m, yaw rad) in base axes,
// where the cost has its minimum. Symmetric, positive semidefinite; zero along directions that are
// not determined.
Eigen::Matrix3d MatchInformation(const MatchPoints& points, const ProbabilityView& view,
                                 const Pose2& map_from_base,
                                 const MatchInformationOptions& options);

}  // namespace depthgrid
