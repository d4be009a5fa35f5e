#include "sim/truth/band_outline.h"

#include <algorithm>
#include <array>
#include <limits>

namespace depthgrid {
namespace {

using Line = std::array<float, 4>;  // x y x y

// Appends the polygon's edges seen from above.
void AddOutline(const BandPolygon& polygon, double resolution_m, std::vector<Line>& lines) {
  for (const auto* corner = polygon.begin(); corner != polygon.end(); ++corner) {
    const auto* next = corner + 1 == polygon.end() ? polygon.begin() : corner + 1;
    std::array<std::array<float, 2>, 2> ends;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      ends[0][axis] = static_cast<float>((*corner)[axis] * resolution_m);
      ends[1][axis] = static_cast<float>((*next)[axis] * resolution_m);
    }
    if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);  // neighbours share it in reverse order
    if (ends[0] != ends[1]) lines.push_back({ends[0][0], ends[0][1], ends[1][0], ends[1][1]});
  }
}

TriangleMesh FencesAlong(std::vector<Line> lines) {
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  TriangleMesh mesh;
  for (const Line& line : lines) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const float z : {0.0F, 1.0F}) {
      mesh.vertices.emplace_back(line[0], line[1], z);
      mesh.vertices.emplace_back(line[2], line[3], z);
    }
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 2});
  }
  return mesh;
}

}  // namespace

BandOutline OutlineOf(const TriangleMesh& mesh, const HeightBand& band, const StateMap& truth) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const GridGeometry& geometry = truth.geometry;
  BandOutline outline;
  outline.height_m.assign(geometry.size(), {kInfinity, -kInfinity});
  std::vector<Line> lines;
  for (const auto& triangle : mesh.triangles) {
    const BandPolygon polygon = InBand(mesh, triangle, band, geometry.resolution_m);
    if (polygon.empty()) continue;
    AddOutline(polygon, geometry.resolution_m, lines);
    ForEachCell(polygon, [&](const Cell& cell, const BandPolygon& strip) {
      const BandPolygon part = strip.Cut(0, cell.x, -1.0).Cut(0, cell.x + 1, 1.0);
      if (part.empty() || !geometry.Contains(cell)) return;
      ValueSpan& height_m = outline.height_m[geometry.Index(cell)];
      height_m = {std::min(height_m.low, part.Min(2)), std::max(height_m.high, part.Max(2))};
    });
  }
  outline.fences = FencesAlong(std::move(lines));
  return outline;
}

std::optional<std::size_t> OccupiedCellAt(const StateMap& truth, const Eigen::Vector2d& hit) {
  constexpr double kRoundingM = 1e-4;
  for (const double dx : {kRoundingM, -kRoundingM}) {
    for (const double dy : {kRoundingM, -kRoundingM}) {
      const Cell cell = CellOf({hit.x() + dx, hit.y() + dy}, truth.geometry.resolution_m);
      if (truth.At(cell) == CellState::kOccupied) return truth.geometry.Index(cell);
    }
  }
  return {};
}

}  // namespace depthgrid
