#include "sim/mesh/face_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "mapper/core/error.h"
#include "sim/mesh/polygon.h"

namespace depthgrid {
namespace {

using FaceTriangles = std::vector<std::array<std::uint32_t, 3>>;

// The face's normal with twice its area as length (Newell); does not depend on the first corner.
Eigen::Vector3d AreaNormal(std::span<const Eigen::Vector3d> corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  return sum;
}

// The corners projected along `normal`, counter-clockwise seen from its tip.
Polygon SeenAlong(const Eigen::Vector3d& normal, std::span<const Eigen::Vector3d> corners) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.normalized().cross(u);
  Polygon polygon;
  for (const Eigen::Vector3d& corner : corners) {
    const Eigen::Vector3d at = corner - corners[0];
    polygon.emplace_back(at.dot(u), at.dot(v));
  }
  return polygon;
}

// Tolerance for a point on a line: files round corners to single precision.
double RoundingM(std::span<const Eigen::Vector3d> corners) {
  double largest_m = 0.0;
  for (const Eigen::Vector3d& corner : corners) {
    largest_m = std::max(largest_m, corner.cwiseAbs().maxCoeff());
  }
  return 4.0 * std::numeric_limits<float>::epsilon() * largest_m;
}

// Signed distance of `p` to the left of the line from a to b.
double LeftOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = b - a, to_p = p - a;
  const double length = along.norm();
  return length > 0.0 ? (along.x() * to_p.y() - along.y() * to_p.x()) / length : 0.0;
}

// Ear clipping of an outline that, unlike the input of Triangulate() in polygon.h, may be rounded,
// not quite flat or self-intersecting.
class RoughOutline {
 public:
  RoughOutline(Polygon polygon, double rounding_m)
      : polygon_(std::move(polygon)), rounding_m_(rounding_m), left_(polygon_.size()) {
    std::iota(left_.begin(), left_.end(), 0U);
  }

  bool IsConvex() const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (HeightOf(i) < -rounding_m_) return false;
    }
    return true;
  }

  FaceTriangles Clipped() {
    FaceTriangles triangles;
    while (left_.size() >= 3) {
      const std::size_t corner = NextEar();
      triangles.push_back({left_[Before(corner)], left_[corner], left_[After(corner)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(corner));
    }
    return triangles;
  }

 private:
  std::size_t Before(std::size_t corner) const {
    return (corner + left_.size() - 1) % left_.size();
  }
  std::size_t After(std::size_t corner) const { return (corner + 1) % left_.size(); }
  const Eigen::Vector2d& At(std::size_t corner) const { return polygon_[left_[corner]]; }
  // Height of a corner over the line between its neighbours, positive outward.
  double HeightOf(std::size_t corner) const {
    return -LeftOf(At(Before(corner)), At(After(corner)), At(corner));
  }

  // The next ear to clip; if there is none, a corner on a straight edge, which removes no area,
  // else any corner.
  std::size_t NextEar() const {
    std::size_t straight = 0;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const double height = HeightOf(i);
      if (height > rounding_m_ && IsClear(i)) return i;
      if (std::abs(height) <= rounding_m_) straight = i;
    }
    return straight;
  }

  // Whether no other corner lies in the triangle at this corner or on its edges.
  bool IsClear(std::size_t corner) const {
    const Eigen::Vector2d &a = At(Before(corner)), &b = At(corner), &c = At(After(corner));
    return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t other) {
      const Eigen::Vector2d& p = polygon_[other];
      if (p == a || p == b || p == c) return false;
      return LeftOf(a, b, p) >= -rounding_m_ && LeftOf(b, c, p) >= -rounding_m_ &&
             LeftOf(c, a, p) >= -rounding_m_;
    });
  }

  Polygon polygon_;
  double rounding_m_;
  std::vector<std::uint32_t> left_;
};

FaceTriangles FanOf(std::size_t corners) {
  FaceTriangles fan;
  for (std::uint32_t k = 2; k < corners; ++k) fan.push_back({0, k - 1, k});
  return fan;
}

}  // namespace

std::optional<FaceTriangles> TrianglesOfFace(std::span<const Eigen::Vector3d> corners) {
  Require(corners.size() >= 3, "a face has at least three corners");
  const Eigen::Vector3d normal = AreaNormal(corners);
  if (!(normal.norm() > 0.0)) return FanOf(corners.size());
  RoughOutline outline(SeenAlong(normal, corners), RoundingM(corners));
  if (outline.IsConvex()) return FanOf(corners.size());
  if (corners.size() > kMostConcaveCorners) return {};
  return outline.Clipped();
}

}  // namespace depthgrid
