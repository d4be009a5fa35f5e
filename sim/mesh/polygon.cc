#include "sim/mesh/polygon.h"

#include <algorithm>
#include <numeric>

namespace depthgrid {
namespace {

using Eigen::Vector2d;

// Twice the area of a b c, positive when counter-clockwise.
double Turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Whether p lies between a and b, given that it is on their line.
bool WithinBox(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return p.x() >= std::min(a.x(), b.x()) && p.x() <= std::max(a.x(), b.x()) &&
         p.y() >= std::min(a.y(), b.y()) && p.y() <= std::max(a.y(), b.y());
}

bool SegmentsTouch(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double c_side = Turn(a, b, c);
  const double d_side = Turn(a, b, d);
  const double a_side = Turn(c, d, a);
  const double b_side = Turn(c, d, b);
  if (((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0)) && c_side != 0 &&
      d_side != 0 && a_side != 0 && b_side != 0) {
    return true;
  }
  return (c_side == 0 && WithinBox(a, b, c)) || (d_side == 0 && WithinBox(a, b, d)) ||
         (a_side == 0 && WithinBox(c, d, a)) || (b_side == 0 && WithinBox(c, d, b));
}

bool Contains(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& p) {
  return Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0 && Turn(c, a, p) >= 0;
}

// Whether the corner between its neighbours can be clipped: convex, no other corner inside.
bool IsEar(const Polygon& polygon, const std::vector<std::uint32_t>& left, std::size_t corner) {
  const std::size_t n = left.size();
  const Vector2d& a = polygon[left[(corner + n - 1) % n]];
  const Vector2d& b = polygon[left[corner]];
  const Vector2d& c = polygon[left[(corner + 1) % n]];
  if (Turn(a, b, c) <= 0) return false;
  for (const std::uint32_t other : left) {
    const Vector2d& p = polygon[other];
    if (p != a && p != b && p != c && Contains(a, b, c, p)) return false;
  }
  return true;
}

}  // namespace

double SignedArea(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2.0;
}

bool IsSimple(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3 || SignedArea(polygon) == 0.0) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % n];
    const Vector2d& c = polygon[(i + 2) % n];
    // Neighbouring edges may share only their corner: the second must not fold back onto the first.
    if (a == b || (Turn(a, b, c) == 0 && (b - a).dot(c - b) <= 0)) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      if (SegmentsTouch(a, b, polygon[j], polygon[(j + 1) % n])) return false;
    }
  }
  return true;
}

std::vector<std::array<std::uint32_t, 3>> Triangulate(const Polygon& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0U);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (left.size() > 3) {
    std::size_t ear = 0;
    while (ear < left.size() && !IsEar(polygon, left, ear)) ++ear;
    // A corner on a straight edge is not an ear itself; when only such corners are left, any of
    // them can be clipped.
    if (ear == left.size()) ear = 0;
    const std::size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace depthgrid
