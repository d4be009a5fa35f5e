#include "mapper/grid/wall_normals.h"

#include <algorithm>

namespace depthgrid {
namespace {

// Sums over points, relative to one of them.
struct LineSums {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void Add(const Eigen::Vector2d& offset) {
    count += 1.0;
    x += offset.x();
    y += offset.y();
    xx += offset.x() * offset.x();
    xy += offset.x() * offset.y();
    yy += offset.y() * offset.y();
  }
};

// Of the least-squares line; `along` where the points are no line.
Eigen::Vector2d NormalOf(const LineSums& sums, const Eigen::Vector2d& along, double least_spread) {
  const double xx = sums.xx - sums.x * sums.x / sums.count;
  const double xy = sums.xy - sums.x * sums.y / sums.count;
  const double yy = sums.yy - sums.y * sums.y / sums.count;
  const double root = std::hypot(xx - yy, 2.0 * xy);
  const double across = 0.5 * (xx + yy - root);
  const double lengthways = 0.5 * (xx + yy + root);
  constexpr double kLeastElongation = 4.0;  // of variances: twice as long as thick
  if (lengthways < sums.count * least_spread * least_spread ||
      lengthways < kLeastElongation * across) {
    return along;
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);  // of the line
  const Eigen::Vector2d normal(-std::sin(angle), std::cos(angle));
  return normal.dot(along) < 0.0 ? Eigen::Vector2d(-normal) : normal;
}

}  // namespace

std::vector<WallHit> WallHits(const Scan& scan, double reach_m) {
  std::vector<Eigen::Vector2d> points;
  for (const Beam& beam : scan.beams) {
    if (beam.hit) points.push_back(EndPoint(beam));
  }
  std::vector<WallHit> hits;
  hits.reserve(points.size());
  const double reach2 = reach_m * reach_m;
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Eigen::Vector2d& point = points[static_cast<std::size_t>(i)];
    LineSums sums;
    sums.Add(Eigen::Vector2d::Zero());
    for (const std::ptrdiff_t step : {-1, 1}) {
      Eigen::Vector2d last = point;
      for (std::ptrdiff_t j = i + step; j >= 0 && j < count; j += step) {
        const Eigen::Vector2d& next = points[static_cast<std::size_t>(j)];
        if ((next - last).squaredNorm() > reach2 || (next - point).squaredNorm() > reach2) break;
        sums.Add(next - point);
        last = next;
      }
    }
    // Evenly spread over +-reach the standard deviation is 0.58 of it; at an end, half of that.
    hits.push_back({point, NormalOf(sums, point.normalized(), 0.2 * reach_m)});
  }
  return hits;
}

}  // namespace depthgrid
