// Rounds corners of polygons and of paths in space by corner cutting.
#pragma once

#include <utility>
#include <vector>

namespace depthgrid {

// Cuts each corner `rounds` times at a quarter of its edges (Chaikin 1974), which converges to a
// quadratic B-spline. The last point of a closed line joins the first; an open one keeps its ends.
// Corners for which `is_kept` is true are not cut.
template <typename Point, typename IsKept>
std::vector<Point> CutCorners(std::vector<Point> line, int rounds, bool closed, IsKept is_kept) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Point> next;
    const std::size_t edges = closed ? line.size() : line.size() - 1;
    if (!closed) next.push_back(line.front());
    for (std::size_t i = 0; i < edges; ++i) {
      const Point& a = line[i];
      const Point& b = line[(i + 1) % line.size()];
      if (closed || i > 0) next.emplace_back(is_kept(a) ? a : Point(0.75 * a + 0.25 * b));
      if ((closed || i + 1 < edges) && !is_kept(b)) next.emplace_back(0.25 * a + 0.75 * b);
    }
    if (!closed) next.push_back(line.back());
    line = std::move(next);
  }
  return line;
}

template <typename Point>
std::vector<Point> CutCorners(std::vector<Point> line, int rounds, bool closed) {
  return CutCorners(std::move(line), rounds, closed, [](const Point&) { return false; });
}

}  // namespace depthgrid
