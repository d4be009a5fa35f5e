#include "mapper/grid/wall_normals.h"

namespace depthgrid {
namespace {

// Sums over a run of hits.
struct LineSums {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void Add(const Eigen::Vector2d& point, double times) {
    count += times;
    x += times * point.x();
    y += times * point.y();
    xx += times * point.x() * point.x();
    xy += times * point.x() * point.y();
    yy += times * point.y() * point.y();
  }
};

// Normal of the least-squares line; `along` if the points do not form a line.
Eigen::Vector2d NormalOf(const LineSums& sums, const Eigen::Vector2d& along, double least_spread) {
  const double xx = sums.xx - sums.x * sums.x / sums.count;
  const double xy = sums.xy - sums.x * sums.y / sums.count;
  const double yy = sums.yy - sums.y * sums.y / sums.count;
  const double root = std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
  const double across = 0.5 * (xx + yy - root);
  const double lengthways = 0.5 * (xx + yy + root);
  constexpr double kLeastElongation = 4.0;  // of variances: twice as long as thick
  if (lengthways < sums.count * least_spread * least_spread ||
      lengthways < kLeastElongation * across) {
    return along;
  }
  // Eigenvector of the smaller eigenvalue, in the form without cancellation.
  const Eigen::Vector2d normal = (xx > yy ? Eigen::Vector2d(-2.0 * xy, xx - yy + root)
                                          : Eigen::Vector2d(yy - xx + root, -2.0 * xy))
                                     .normalized();
  return normal.dot(along) < 0.0 ? Eigen::Vector2d(-normal) : normal;
}

}  // namespace

void FindWallHits(const Scan& scan, double reach_m, std::vector<WallHit>& hits) {
  hits.clear();
  for (const Beam& beam : scan.beams) {
    if (beam.hit) hits.push_back({.point = EndPoint(beam)});
  }
  const double reach2 = reach_m * reach_m;
  const auto within_reach = [&](std::size_t i, std::size_t j) {
    return (hits[i].point - hits[j].point).squaredNorm() <= reach2;
  };
  LineSums sums;  // over the run [first, end) around hit i
  std::size_t first = 0, end = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (end <= i) {
      sums = {};
      sums.Add(hits[i].point, 1.0);
      first = i;
      end = i + 1;
    }
    for (; end < hits.size() && within_reach(end, end - 1) && within_reach(end, i); ++end) {
      sums.Add(hits[end].point, 1.0);
    }
    for (; !within_reach(first, i); ++first) sums.Add(hits[first].point, -1.0);
    // Points spread evenly over +-reach have a standard deviation of 0.58 reach, at a wall's end
    // half of that.
    hits[i].normal = NormalOf(sums, hits[i].point.normalized(), 0.2 * reach_m);
  }
}

}  // namespace depthgrid
