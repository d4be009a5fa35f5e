#include "sim/truth/band_polygon.h"

namespace depthgrid {
namespace {

double SnappedTo(double value, double target, double tolerance) {
  return std::abs(value - target) < tolerance ? target : value;
}

double OnGrid(double cells, double tolerance_cells) {
  return SnappedTo(cells, std::round(cells), tolerance_cells);
}

// Least height of a triangle over its longest side: rays do not hit triangles without area, which
// occur in meshes with collinear corners. Rounding to single precision moves a corner off the line
// by up to this at 50 m from the origin.
constexpr double kThinnestM = 5e-6;

bool HasArea(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
    return mesh.vertices[triangle[k % 3]].cast<double>();
  };
  double longest_m = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest_m = std::max(longest_m, (corner(k + 1) - corner(k)).norm());
  }
  const double twice_area_m2 = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  return twice_area_m2 > kThinnestM * longest_m;
}

}  // namespace

BandPolygon BandPolygon::Cut(std::size_t axis, double bound, double sign) const {
  constexpr double kRoundingCells = 1e-6;  // for snapped corners and the interpolation below
  BandPolygon kept;
  for (int i = 0; i < size_; ++i) {
    const Corner& a = corners_[static_cast<std::size_t>(i)];
    const Corner& b = corners_[static_cast<std::size_t>((i + 1) % size_)];
    const double beyond_a = sign * (a[axis] - bound), beyond_b = sign * (b[axis] - bound);
    if (beyond_a <= 0) kept.Add(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0)) {
      const double t = beyond_a / (beyond_a - beyond_b);
      Corner crossing = {OnGrid(a[0] + t * (b[0] - a[0]), kRoundingCells),
                         OnGrid(a[1] + t * (b[1] - a[1]), kRoundingCells),
                         a[2] + t * (b[2] - a[2])};
      crossing[axis] = bound;
      kept.Add(crossing);
    }
  }
  return kept;
}

double BandPolygon::Min(std::size_t axis) const {
  double low = corners_[0][axis];
  for (const Corner& corner : *this) low = std::min(low, corner[axis]);
  return low;
}

double BandPolygon::Max(std::size_t axis) const {
  double high = corners_[0][axis];
  for (const Corner& corner : *this) high = std::max(high, corner[axis]);
  return high;
}

BandPolygon InBand(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle,
                   const HeightBand& band, double resolution_m) {
  constexpr double kSnapM = 1e-5;  // single precision rounds by up to 2 um at 50 m
  BandPolygon polygon;
  for (const std::uint32_t index : triangle) {
    const Eigen::Vector3d vertex = mesh.vertices[index].cast<double>();
    polygon.Add({OnGrid(vertex.x() / resolution_m, kSnapM / resolution_m),
                 OnGrid(vertex.y() / resolution_m, kSnapM / resolution_m),
                 SnappedTo(SnappedTo(vertex.z(), band.low_z_m, kSnapM), band.high_z_m, kSnapM)});
  }
  if (polygon.Max(2) < band.low_z_m || polygon.Min(2) > band.high_z_m) return {};
  if (!HasArea(mesh, triangle)) return {};
  return polygon.Cut(2, band.low_z_m, -1.0).Cut(2, band.high_z_m, 1.0);
}

}  // namespace depthgrid
