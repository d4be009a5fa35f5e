#include "eval/metrics/map_registration.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <vector>

#include "eval/metrics/cell_maps.h"
#include "eval/metrics/distance_transform.h"
#include "eval/metrics/spline_field.h"

namespace depthgrid {
namespace {

// The estimate's walls in cells. The motion rotates them about their centroid, so that rotation and
// translation are nearly uncorrelated.
struct WallPoints {
  Eigen::Vector2d centroid;
  std::vector<Eigen::Vector2d> from_centroid;
  double mean_squared_radius = 0.0;
};

// More points than these only cost time: the walls of a room are about 2,000 cells.
constexpr std::size_t kMostPoints = 4000;

WallPoints PointsOf(const PlacedWalls& placed) {
  const std::vector<Eigen::Vector2d> centres_m = CentresOf(placed.walls);
  const std::size_t stride = centres_m.size() / kMostPoints + 1;
  WallPoints points;
  points.centroid.setZero();
  for (std::size_t i = 0; i < centres_m.size(); i += stride) {
    points.from_centroid.push_back(placed.truth_from_cells * centres_m[i] /
                                   placed.walls.geometry.resolution_m);
    points.centroid += points.from_centroid.back();
  }
  const auto count = static_cast<double>(points.from_centroid.size());
  points.centroid /= count;
  for (Eigen::Vector2d& p : points.from_centroid) {
    p -= points.centroid;
    points.mean_squared_radius += p.squaredNorm() / count;
  }
  return points;
}

struct Correlation {
  double value = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // x cells, y cells, yaw rad
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// Penalty for motion, so that walls that do not constrain a direction are not moved along it: half
// of this times the squared distance that each wall cell moves, in cells. At 16 cells it is 0.013,
// against the 0.67 gained on a true wall, and it biases well-constrained walls by 0.002 cells.
constexpr double kCostOfMotion = 1e-4;

Correlation CorrelationAt(const WallPoints& points, const SplineField& field,
                          const Eigen::Vector3d& motion) {
  const double c = std::cos(motion.z());
  const double s = std::sin(motion.z());
  Correlation sum;
  for (const Eigen::Vector2d& p : points.from_centroid) {
    const Eigen::Vector2d turned(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    const SplineSample at = field.At(points.centroid + motion.head<2>() + turned);
    const Eigen::Vector2d by_yaw(-turned.y(), turned.x());
    const Eigen::Vector2d hessian_by_yaw = at.hessian * by_yaw;
    sum.value += at.value;
    sum.gradient.head<2>() += at.gradient;
    sum.gradient.z() += at.gradient.dot(by_yaw);
    sum.hessian.topLeftCorner<2, 2>() += at.hessian;
    sum.hessian.topRightCorner<2, 1>() += hessian_by_yaw;
    sum.hessian(2, 2) += by_yaw.dot(hessian_by_yaw) - at.gradient.dot(turned);
  }
  sum.hessian.bottomLeftCorner<1, 2>() = sum.hessian.topRightCorner<2, 1>().transpose();
  const Eigen::Vector3d cost = kCostOfMotion * static_cast<double>(points.from_centroid.size()) *
                               Eigen::Vector3d(1.0, 1.0, points.mean_squared_radius);
  sum.value -= 0.5 * cost.dot(motion.cwiseAbs2());
  sum.gradient -= cost.cwiseProduct(motion);
  sum.hessian.diagonal() -= cost;
  return sum;
}

// Maximises by Newton's method; where the Hessian is not negative definite, it is damped towards
// the gradient (Levenberg).
Eigen::Vector3d Climb(const WallPoints& points, const SplineField& field, Eigen::Vector3d motion) {
  constexpr int kMostSteps = 40;
  constexpr double kConverged = 1e-5;  // cells
  constexpr double kMostDamping = 1e9;
  const Eigen::Vector3d scale(1.0, 1.0, std::max(1.0, points.mean_squared_radius));
  Correlation here = CorrelationAt(points, field, motion);
  double damping = 1e-3 * static_cast<double>(points.from_centroid.size());
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    Eigen::Matrix3d curvature = -here.hessian;
    curvature.diagonal() += damping * scale;
    const Eigen::LLT<Eigen::Matrix3d> solver(curvature);
    if (solver.info() != Eigen::Success) {
      damping *= 4.0;
      continue;
    }
    const Eigen::Vector3d change = solver.solve(here.gradient);
    const Correlation there = CorrelationAt(points, field, motion + change);
    if (!(there.value > here.value)) {
      damping *= 4.0;
      continue;
    }
    motion += change;
    here = there;
    damping *= 0.25;
    const Eigen::Vector3d moved = change.cwiseProduct(scale.cwiseSqrt());
    if (moved.cwiseAbs().maxCoeff() < kConverged) break;
  }
  return motion;
}

// The better of two searches: from coarse to fine, and at the finest level only, from the unmoved
// map. Where walls do not constrain a direction, the coarse levels could move it far along it.
Eigen::Vector3d BestMotion(const WallPoints& points, const CellSet& true_walls,
                           const SplineField& finest) {
  // Three box filters of radius r reach 3 r + 2 cells; the last level is the walls themselves.
  constexpr std::array<int, 3> kSmoothingRadii = {6, 3, 1};
  const Eigen::Vector3d near = Climb(points, finest, Eigen::Vector3d::Zero());
  Eigen::Vector3d far = Eigen::Vector3d::Zero();
  for (const int radius : kSmoothingRadii) {
    far = Climb(points, SplineField(true_walls, radius), far);
  }
  far = Climb(points, finest, far);
  const bool farther_is_better =
      CorrelationAt(points, finest, far).value > CorrelationAt(points, finest, near).value;
  return farther_is_better ? far : near;
}

}  // namespace

CellSet WallFaces(const StateMap& map) {
  return InBoth(CellsIn(map, CellState::kOccupied), Grown(CellsIn(map, CellState::kFree), 1));
}

CellSet FacesNear(const StateMap& map, const CellSet& scored) {
  constexpr int kNearCells = 2;
  return InBoth(WallFaces(map), Grown(scored, kNearCells));
}

std::optional<MapRegistration> RegisterWalls(const StateMap& truth, const PlacedWalls& estimate,
                                             const CellSet& scored) {
  const CellSet true_walls = FacesNear(truth, scored);
  if (CentresOf(true_walls).empty() || CentresOf(estimate.walls).empty()) return std::nullopt;
  const WallPoints points = PointsOf(estimate);
  const SplineField finest(true_walls, 0);
  const Eigen::Vector3d motion = BestMotion(points, true_walls, finest);
  if (CorrelationAt(points, finest, motion).value <= 0.0) return std::nullopt;
  const double resolution_m = truth.geometry.resolution_m;
  // x -> centroid + shift + R (x - centroid), as a pose.
  const Pose2 turn{0.0, 0.0, WrapAngle(motion.z())};
  const Eigen::Vector2d shift_cells = points.centroid + motion.head<2>() - turn * points.centroid;
  return RegistrationBy(
      {shift_cells.x() * resolution_m, shift_cells.y() * resolution_m, turn.yaw_rad}, estimate);
}

MapRegistration RegistrationBy(const Pose2& truth_from_estimate, const PlacedWalls& estimate) {
  MapRegistration result{truth_from_estimate, 0.0};
  const std::vector<Eigen::Vector2d> centres_m = CentresOf(estimate.walls);
  for (const Eigen::Vector2d& centre : centres_m) {
    const Eigen::Vector2d p = estimate.truth_from_cells * centre;
    result.mean_shift_m +=
        (truth_from_estimate * p - p).norm() / static_cast<double>(centres_m.size());
  }
  return result;
}

}  // namespace depthgrid
