#include "mapper/match/find_place.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// Returns used in all, spread over the scans: enough to tell rooms apart, few enough to try some
// million places.
constexpr std::size_t kPoints = 320;
constexpr std::size_t kCoarsePoints = 64;
constexpr double kCoarseStepM = 0.1;
// A map holds what was seen, and a camera does not see where it stands.
constexpr double kMarginM = 2.0;
constexpr int kHeadings = 90;  // 4 degrees apart: 0.2 m at 3 m, which the score's width bridges
// A return this far from a wall still counts exp(-1/2).
constexpr double kCoarseSigmaM = 0.15;
constexpr double kFineSigmaM = 0.06;
constexpr double kFarthestM = 0.6;
constexpr std::size_t kRefined = 60;
constexpr double kElsewhereM = 1.0;
constexpr double kElsewhereRad = RadFromDeg(30.0);
// The guess needs this share of the best score.
constexpr double kGuessShare = 0.9;
// Where along its way a beam asks whether the map is free, and what the answer is worth beside its
// end: walls alone fit in many places, also outside of the map, where no free space does.
constexpr double kOnTheWay[] = {0.3, 0.6, 0.85};
constexpr double kFreeWorth = 0.5;

// Distance to the nearest wall, cut at kFarthestM, and what the cells are.
class WallDistance {
 public:
  explicit WallDistance(const OccupancyMap& map)
      : geometry_(map.geometry), distance_m_(map.geometry.size(), static_cast<float>(kFarthestM)) {
    states_ = StatesOf(map).states;
    for (std::size_t i = 0; i < distance_m_.size(); ++i) {
      if (states_[i] != CellState::kOccupied) continue;
      distance_m_[i] = 0.0F;
      any_ = true;
    }
    Sweep(1);
    Sweep(-1);
  }
  bool any() const { return any_; }
  double At(const Eigen::Vector2d& point_m) const {
    const Cell cell = CellOf(point_m, geometry_.resolution_m);
    return geometry_.Contains(cell) ? distance_m_[geometry_.Index(cell)] : kFarthestM;
  }
  // 1 free, 0 not seen, -1 a wall.
  int FreeAt(const Eigen::Vector2d& point_m) const {
    const Cell cell = CellOf(point_m, geometry_.resolution_m);
    if (!geometry_.Contains(cell)) return 0;
    const CellState state = states_[geometry_.Index(cell)];
    return state == CellState::kUnknown ? 0 : state == CellState::kFree ? 1 : -1;
  }

 private:
  // A chamfer sweep (Borgefors 1986, weights 1 and sqrt 2): within 8 % of the Euclidean distance.
  void Sweep(int way) {
    const auto near = static_cast<float>(geometry_.resolution_m);
    const float diagonal = near * std::sqrt(2.0F);
    const int width = geometry_.width_cells;
    const int height = geometry_.height_cells;
    const auto at = [&](int x, int y) -> float& {
      return distance_m_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x)];
    };
    for (int row = 0; row < height; ++row) {
      const int y = way > 0 ? row : height - 1 - row;
      for (int column = 0; column < width; ++column) {
        const int x = way > 0 ? column : width - 1 - column;
        float& here = at(x, y);
        const auto from = [&](int dx, int dy, float step) {
          const int nx = x - way * dx;
          const int ny = y - way * dy;
          if (nx < 0 || ny < 0 || nx >= width || ny >= height) return;
          here = std::min(here, at(nx, ny) + step);
        };
        from(1, 0, near);
        from(0, 1, near);
        from(1, 1, diagonal);
        from(-1, 1, diagonal);
      }
    }
  }

  GridGeometry geometry_;
  std::vector<float> distance_m_;
  std::vector<CellState> states_;
  bool any_ = false;
};

// A return, with the sensor that saw it.
struct Return {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};
using Points = std::vector<Return>;

// Every n-th return of all scans, in the axes of the first scan's base.
Points PointsOf(const std::vector<PlacedScan>& scans, std::size_t wanted) {
  Points all;
  const Pose2 first_from_slam = Inverse(scans.front().slam_from_base);
  for (const PlacedScan& placed : scans) {
    const Pose2 first_from_base = first_from_slam * placed.slam_from_base;
    for (const Beam& beam : placed.scan->beams) {
      if (!beam.hit) continue;
      all.push_back({first_from_base.translation(), first_from_base * EndPoint(beam)});
    }
  }
  Points chosen;
  for (std::size_t i = 0; i < wanted && !all.empty(); ++i) {
    chosen.push_back(all[i * all.size() / wanted]);
  }
  return chosen;
}

double ScoreOf(const WallDistance& walls, const Points& points, const Pose2& map_from_first,
               double sigma_m) {
  const double c = std::cos(map_from_first.yaw_rad);
  const double s = std::sin(map_from_first.yaw_rad);
  double sum = 0.0;
  const auto in_map = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(map_from_first.x_m + c * p.x() - s * p.y(),
                           map_from_first.y_m + s * p.x() + c * p.y());
  };
  for (const Return& point : points) {
    const Eigen::Vector2d from = in_map(point.from);
    const Eigen::Vector2d to = in_map(point.to);
    const double d = walls.At(to) / sigma_m;
    sum += std::exp(-0.5 * d * d);
    int free = 0;
    for (const double share : kOnTheWay) free += walls.FreeAt(from + share * (to - from));
    sum += kFreeWorth * free / static_cast<double>(std::size(kOnTheWay));
  }
  return sum / ((1.0 + kFreeWorth) * static_cast<double>(points.size()));
}

struct Candidate {
  Pose2 map_from_first;
  double score = 0.0;
};

std::vector<Candidate> Coarse(const OccupancyMap& map, const WallDistance& walls,
                              const Points& points) {
  std::vector<Candidate> best;
  const auto better = [](const Candidate& a, const Candidate& b) { return a.score > b.score; };
  const GridGeometry& g = map.geometry;
  const int step = std::max(1, static_cast<int>(std::lround(kCoarseStepM / g.resolution_m)));
  const int margin = static_cast<int>(std::lround(kMarginM / g.resolution_m));
  for (int y = -margin; y < g.height_cells + margin; y += step) {
    for (int x = -margin; x < g.width_cells + margin; x += step) {
      const Cell cell{g.min_cell.x + x, g.min_cell.y + y};
      // The robot's own place may not have been seen, but it is no wall.
      if (StateOf(map.At(cell), {}) == CellState::kOccupied) continue;
      const Eigen::Vector2d centre = CellCentre(cell, g.resolution_m);
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Pose2 pose{centre.x(), centre.y(), WrapAngle(2.0 * kPi * heading / kHeadings)};
        const double score = ScoreOf(walls, points, pose, kCoarseSigmaM);
        if (best.size() == kRefined && score <= best.front().score) continue;
        // A heap with the worst of the best in front.
        if (best.size() == kRefined) {
          std::pop_heap(best.begin(), best.end(), better);
          best.pop_back();
        }
        best.push_back({pose, score});
        std::push_heap(best.begin(), best.end(), better);
      }
    }
  }
  return best;
}

// Steps along each axis, halved when none is better.
Candidate Refined(const WallDistance& walls, const Points& points, const Pose2& start) {
  Candidate best{start, ScoreOf(walls, points, start, kFineSigmaM)};
  Eigen::Vector3d step(0.05, 0.05, RadFromDeg(2.0));
  constexpr int kHalvings = 5;
  for (int halving = 0; halving < kHalvings;) {
    bool moved = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Eigen::Vector3d change = Eigen::Vector3d::Zero();
        change[axis] = sign * step[axis];
        const Pose2 pose = best.map_from_first * Pose2::FromVector(change);
        const double score = ScoreOf(walls, points, pose, kFineSigmaM);
        if (score <= best.score) continue;
        best = {pose, score};
        moved = true;
      }
    }
    if (moved) continue;
    step *= 0.5;
    ++halving;
  }
  return best;
}

bool Elsewhere(const Pose2& a, const Pose2& b) {
  const Pose2 between = Between(a, b);
  return std::hypot(between.x_m, between.y_m) > kElsewhereM ||
         std::abs(between.yaw_rad) > kElsewhereRad;
}

}  // namespace

std::optional<FoundPlace> FindPlace(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
                                    const Pose2& guess) {
  if (scans.empty()) return {};
  const WallDistance walls(map);
  const Points points = PointsOf(scans, kPoints);
  if (!walls.any() || points.empty()) return {};
  std::vector<Candidate> candidates;
  for (const Candidate& coarse : Coarse(map, walls, PointsOf(scans, kCoarsePoints))) {
    candidates.push_back(Refined(walls, points, coarse.map_from_first));
  }
  const Pose2& slam_from_first = scans.front().slam_from_base;
  const Candidate guessed = Refined(walls, points, guess * slam_from_first);
  Candidate best = guessed;
  for (const Candidate& candidate : candidates) {
    if (candidate.score > best.score) best = candidate;
  }
  if (guessed.score >= kGuessShare * best.score) best = guessed;
  FoundPlace found{best.map_from_first * Inverse(slam_from_first), best.score, 0.0};
  for (const Candidate& candidate : candidates) {
    if (Elsewhere(candidate.map_from_first, best.map_from_first)) {
      found.second_score = std::max(found.second_score, candidate.score);
    }
  }
  return found;
}

}  // namespace depthgrid
