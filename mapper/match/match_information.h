// The inverse covariance of a match in a submap (docs/math.md, "Scan matching").
#pragma once

#include "mapper/core/options.h"
#include "mapper/match/match_cost.h"

namespace depthgrid {

enum class InformationSource { kCurvature, kSurface };

struct MatchInformationOptions {
  // `curvature`: from derivatives at the match, the options down to wall_direction_sigma_rad.
  // `surface`: from the scores of the poses around it (score_surface.h), the options after that.
  // Both are calibrated on the laser testbed; the surface costs three times a match.
  InformationSource source = InformationSource::kCurvature;
  // Beams that end within this distance of each other share their error, as they meet the same
  // cells. 0.05-0.2 m fit the errors on the laser testbed equally well.
  double patch_m = 0.1;
  // Standard deviation of the map's wall position, per patch. 0.015 m on the laser testbed, at 5 cm
  // and at 2.5 cm cells alike.
  double map_sigma_m = 0.015;
  // Uncertainty of the direction of walls in the map. Information along walls that such an error
  // could cause is removed, so that a corridor's axis stays undetermined; 0 removes nothing.
  // Corridors oblique to the cells need 0.13 (0.2 at worst), 95 % of the views of furnished rooms
  // have more than that.
  double wall_direction_sigma_rad = 0.15;
  // Half widths of the window whose scores are taken.
  double surface_window_m = 0.2;
  double surface_window_deg = 6.0;
  // A pose weighs exp(surface_sharpness (sum of the points' probabilities - the best sum)).
  double surface_sharpness = 1.0;
  // The covariance is multiplied by this; 1 is calibrated with the values above.
  double covariance_scale = 1.0;

  void Visit(OptionsVisitor& v);
};

// Sums over a scan's points at a pose, in map axes about base: second derivatives of 1/2 (1 - M)^2
// with respect to (x m, y m, yaw rad).
struct InformationSums {
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();
  // The same with every wall turned by 90 degrees.
  Eigen::Matrix3d curvature_along_walls = Eigen::Matrix3d::Zero();
  // Covariance of the gradient: scatter between patches, and the effect of shifting each patch's
  // wall by map_sigma_m.
  Eigen::Matrix3d gradient_covariance = Eigen::Matrix3d::Zero();
  int explained = 0;  // points where the map is more likely occupied
};

// Above this a cell counts as occupied: halfway between unknown (0.5) and one hit (0.55).
constexpr double kExplainedProb = 0.525;
// Patches begin at multiples of this many points.
constexpr int kPatchStep = 8;

// The plain reference, in double.
InformationSums SumUpInformation(const MatchPoints& points, const ProbabilityView& view,
                                 const Pose2& map_from_base,
                                 const MatchInformationOptions& options);

// Adds the patch's share to the covariance of the gradient, from its gradient and its curvature
// with respect to a shift of its wall (rows: x, y, yaw of the pose).
void AddPatch(const Eigen::Vector3d& gradient, const Eigen::Matrix<double, 3, 2>& shift_curvature,
              double map_sigma_m, Eigen::Matrix3d& gradient_covariance);

// Turns a small motion in base axes (forward, left, yaw) into one in map axes (x, y, yaw).
Eigen::Matrix3d MapFromBaseAxes(double yaw_rad);

// Inverse covariance of map_from_base for a small motion (forward m, left m, yaw rad) in base axes.
// Symmetric, positive semidefinite; zero along directions that are not determined.
Eigen::Matrix3d MatchInformation(const InformationSums& sums, const Pose2& map_from_base,
                                 const MatchInformationOptions& options);

// The information without directions whose standard deviation exceeds `max_sigma_m`; `arm_m` is the
// lever arm that converts rotations to metres.
Eigen::Matrix3d WithoutWeakDirections(const Eigen::Matrix3d& information, double max_sigma_m,
                                      double arm_m);

// The matched pose, but the predicted one along directions without information, where the search
// stopped arbitrarily. `arm_m` as above.
Pose2 WithUndeterminedFrom(const Pose2& predicted_map_from_base, const Pose2& matched_map_from_base,
                           const Eigen::Matrix3d& information, double arm_m);

}  // namespace depthgrid
