#include "mapper/match/find_place.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "mapper/core/angle.h"
#include "mapper/match/distance_field.h"

namespace depthgrid {
namespace {

// Returns used in all, spread over the scans: enough to tell rooms apart, few enough to try some
// million places.
constexpr std::size_t kPoints = 320;
constexpr std::size_t kCoarsePoints = 64;
constexpr double kCoarseStepM = 0.1;
// The lattice's cells are the map's, or several of them together: where those are smaller than
// this, or with all that the returns can reach would be more than half a gigabyte.
constexpr double kCoarseCellM = 0.05;
constexpr std::size_t kMostCoarseCells = std::size_t{1} << 26;
// A map holds what was seen, and a camera does not see where it stands.
constexpr double kMarginM = 2.0;
constexpr int kHeadings = 90;  // 4 degrees apart: 0.2 m at 3 m, which the score's width bridges
// A return this far from a wall still counts exp(-1/2).
constexpr double kCoarseSigmaM = 0.15;
constexpr double kFineSigmaM = 0.06;
constexpr double kFarthestM = 0.6;
constexpr std::size_t kRefined = 60;
// Places this near to each other are one.
constexpr double kApartM = 0.3;
constexpr double kApartRad = RadFromDeg(8.0);
constexpr double kOtherShare = 0.8;
constexpr std::size_t kMostOthers = 7;
// A refinement begins with steps of half the lattice's, which end at 1.6 mm and 0.06 degrees.
constexpr double kFirstStepM = 0.05;
constexpr double kFirstStepRad = RadFromDeg(2.0);
constexpr int kHalvings = 5;
constexpr double kElsewhereM = 1.0;
constexpr double kElsewhereRad = RadFromDeg(30.0);
// What lies this near to the guess (SLAM's drift since the map was made) needs this share of the
// best score.
constexpr double kGuessShare = 0.9;
constexpr double kGuessReachM = 1.5;
constexpr double kGuessReachRad = RadFromDeg(12.0);
constexpr double kGuessStepM = 0.15;
constexpr double kGuessStepRad = RadFromDeg(4.0);
constexpr std::size_t kGuessesRefined = 10;
// What is this near to the best score may be the place as well; looked for along so many lines.
constexpr double kUnsureShare = 0.97;
constexpr int kUnsureLines = 36;  // 5 degrees apart: at 1 m half of that is 4 cm across
constexpr double kUnsureStepM = 0.05;
constexpr double kUnsureReachM = 5.0;
// Less than this is found by matching: of 40 starts in two rooms those right to 2 cm had 0.16 m and
// less, but for four of which another place fitted nearly as well.
constexpr double kLeastUnsureM = 0.2;
// What free space on a beam's way is worth beside its end: walls alone fit in many places, also
// outside of the map, where no free space does.
constexpr double kFreeWorth = 0.5;

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

double ScoreOf(const DistanceField& walls, const Points& points, const Pose2& map_from_first,
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

// The map with a margin of unseen cells, so that every candidate's returns lie in it: what a return
// is worth that ends in a cell, and one that passes through it.
class CoarseMap {
 public:
  CoarseMap(const GridGeometry& geometry, const DistanceField& walls) : geometry_(geometry) {
    cells_.reserve(geometry_.size());
    for (std::size_t i = 0; i < geometry_.size(); ++i) {
      const Eigen::Vector2d centre = CellCentre(geometry_.CellAt(i), geometry_.resolution_m);
      const double d = walls.At(centre) / kCoarseSigmaM;
      const double free = kFreeWorth / static_cast<double>(std::size(kOnTheWay));
      cells_.push_back({static_cast<float>(std::exp(-0.5 * d * d)),
                        static_cast<float>(free * walls.FreeAt(centre))});
    }
  }

  // A return's four cells, relative to the candidate's.
  struct Offsets {
    std::ptrdiff_t end = 0;
    std::ptrdiff_t on_the_way[std::size(kOnTheWay)] = {};
  };
  std::vector<Offsets> OffsetsAt(const Points& points, double heading_rad, double reach_m) const {
    const Eigen::Rotation2Dd turn(heading_rad);
    const auto offset_of = [&](const Eigen::Vector2d& point) {
      // What lies farther is outside of the map from everywhere, and so is this.
      const double share = std::min(1.0, reach_m / std::max(point.norm(), 1e-9));
      // From the middle of a cell.
      const Cell cell = CellOf((turn * (share * point)).array() + 0.5 * geometry_.resolution_m,
                               geometry_.resolution_m);
      return static_cast<std::ptrdiff_t>(cell.y) * geometry_.width_cells + cell.x;
    };
    std::vector<Offsets> offsets;
    for (const Return& point : points) {
      Offsets& offset = offsets.emplace_back();
      offset.end = offset_of(point.to);
      for (std::size_t i = 0; i < std::size(kOnTheWay); ++i) {
        offset.on_the_way[i] = offset_of(point.from + kOnTheWay[i] * (point.to - point.from));
      }
    }
    return offsets;
  }

  // 0..1, or less than `least` as soon as it cannot be reached.
  double ScoreAt(const Cell& cell, const std::vector<Offsets>& offsets, double least) const {
    const CellWorth* here = cells_.data() + geometry_.Index(cell);
    const auto most = static_cast<float>(1.0 + kFreeWorth);
    const auto count = static_cast<float>(offsets.size());
    // What may be lost; not to a last digit.
    float spare = (1.0F - static_cast<float>(least)) * most * count + 1e-3F;
    float sum = 0.0F;
    for (const Offsets& offset : offsets) {
      float worth = here[offset.end].as_end;
      for (const std::ptrdiff_t way : offset.on_the_way) worth += here[way].on_the_way;
      sum += worth;
      spare -= most - worth;
      if (spare < 0.0F) return 0.0;
    }
    return sum / (most * count);
  }

 private:
  struct CellWorth {
    float as_end = 0.0F;
    float on_the_way = 0.0F;
  };
  GridGeometry geometry_;
  std::vector<CellWorth> cells_;
};

// The farthest that a point or sensor lies from the first scan's base.
double ReachOf(const Points& points) {
  double reach_m = 0.0;
  for (const Return& point : points) {
    reach_m = std::max({reach_m, point.from.norm(), point.to.norm()});
  }
  return reach_m;
}

// The map's cells in squares of `side` a coarser one, as many as it takes to cover them.
GridGeometry Coarser(const GridGeometry& fine, int side) {
  const auto down = [&](int cell) {
    return static_cast<int>(std::floor(static_cast<double>(cell) / side));
  };
  const Cell first{down(fine.min_cell.x), down(fine.min_cell.y)};
  return {side * fine.resolution_m, first,
          down(fine.min_cell.x + fine.width_cells - 1) - first.x + 1,
          down(fine.min_cell.y + fine.height_cells - 1) - first.y + 1};
}

// What is searched, and with all that returns can end in from there.
struct CoarseGeometry {
  GridGeometry map;
  int margin_cells = 0;
  GridGeometry reached;
};

CoarseGeometry GeometryOf(const GridGeometry& fine, double reach_m) {
  const auto least = static_cast<int>(std::ceil(kCoarseCellM / fine.resolution_m - 1e-6));
  for (int side = std::max(1, least);; side *= 2) {
    CoarseGeometry coarse;
    coarse.map = Coarser(fine, side);
    const double cell_m = coarse.map.resolution_m;
    coarse.margin_cells = static_cast<int>(std::lround(kMarginM / cell_m));
    const int reach = static_cast<int>(std::ceil(reach_m / cell_m)) + 2;
    coarse.reached = Widened(coarse.map, coarse.margin_cells + reach);
    if (coarse.reached.size() <= kMostCoarseCells) return coarse;
  }
}

// The best places on a lattice of cells and headings, which is the same but for rounding to cells
// as ScoreOf there.
std::vector<Candidate> Coarse(const OccupancyMap& map, const DistanceField& walls,
                              const Points& points) {
  std::vector<Candidate> best;
  const auto better = [](const Candidate& a, const Candidate& b) { return a.score > b.score; };
  const GridGeometry& fine = map.geometry;
  const double across_m =
      fine.resolution_m * std::hypot(fine.width_cells, fine.height_cells) + 2.0 * kMarginM;
  const double reach_m = std::min(ReachOf(points), across_m);
  const auto [g, margin, reached] = GeometryOf(fine, reach_m);
  const int step = std::max(1, static_cast<int>(std::lround(kCoarseStepM / g.resolution_m)));
  const CoarseMap coarse(reached, walls);
  for (int heading = 0; heading < kHeadings; ++heading) {
    const double heading_rad = WrapAngle(2.0 * kPi * heading / kHeadings);
    const auto offsets = coarse.OffsetsAt(points, heading_rad, reach_m);
    for (int y = -margin; y < g.height_cells + margin; y += step) {
      for (int x = -margin; x < g.width_cells + margin; x += step) {
        const Cell cell{g.min_cell.x + x, g.min_cell.y + y};
        // The robot's own place may not have been seen, but it is no wall.
        if (walls.FreeAt(CellCentre(cell, g.resolution_m)) < 0) continue;
        const double least = best.size() == kRefined ? best.front().score : 0.0;
        const double score = coarse.ScoreAt(cell, offsets, least);
        if (best.size() == kRefined && score <= least) continue;
        // A heap with the worst of the best in front.
        if (best.size() == kRefined) {
          std::pop_heap(best.begin(), best.end(), better);
          best.pop_back();
        }
        const Eigen::Vector2d centre = CellCentre(cell, g.resolution_m);
        best.push_back({{centre.x(), centre.y(), heading_rad}, score});
        std::push_heap(best.begin(), best.end(), better);
      }
    }
  }
  return best;
}

// Steps along each axis, halved when none is better.
Candidate Refined(const DistanceField& walls, const Points& points, const Pose2& start) {
  Candidate best{start, ScoreOf(walls, points, start, kFineSigmaM)};
  Eigen::Vector3d step(kFirstStepM, kFirstStepM, kFirstStepRad);
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

// The best place within reach of `guess`.
Candidate NearGuess(const DistanceField& walls, const Points& coarse_points, const Points& points,
                    const Pose2& guess) {
  std::vector<Candidate> around;
  const int steps = static_cast<int>(kGuessReachM / kGuessStepM);
  const int turns = static_cast<int>(kGuessReachRad / kGuessStepRad);
  for (int turn = -turns; turn <= turns; ++turn) {
    for (int y = -steps; y <= steps; ++y) {
      for (int x = -steps; x <= steps; ++x) {
        const Pose2 pose{guess.x_m + x * kGuessStepM, guess.y_m + y * kGuessStepM,
                         WrapAngle(guess.yaw_rad + turn * kGuessStepRad)};
        around.push_back({pose, ScoreOf(walls, coarse_points, pose, kCoarseSigmaM)});
      }
    }
  }
  std::stable_sort(around.begin(), around.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  Candidate best = Refined(walls, points, guess);
  for (std::size_t i = 0; i < kGuessesRefined; ++i) {
    const Candidate refined = Refined(walls, points, around[i].map_from_first);
    if (refined.score > best.score) best = refined;
  }
  return best;
}

// The next one, unless another within reach is much better: what is known beforehand is kept where
// little is seen, as along a corridor.
Candidate NextTo(const DistanceField& walls, const Points& coarse_points, const Points& points,
                 const Pose2& known) {
  const Candidate next = Refined(walls, points, known);
  const Candidate best = NearGuess(walls, coarse_points, points, known);
  return next.score >= kGuessShare * best.score ? next : best;
}

// Those that may be the place too, best first.
std::vector<Pose2> OthersThan(const Candidate& best, std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Pose2> others;
  for (const Candidate& candidate : candidates) {
    if (others.size() == kMostOthers || candidate.score < kOtherShare * best.score) break;
    const Pose2& pose = candidate.map_from_first;
    const auto is_apart = [&](const Pose2& other) {
      return AreApart(other, pose, kApartM, kApartRad);
    };
    if (!is_apart(best.map_from_first)) continue;
    if (std::all_of(others.begin(), others.end(), is_apart)) others.push_back(pose);
  }
  return others;
}

// How far to either side of the place, and along which line farthest, the score stays near its own.
UnsureAlong UnsureLine(const DistanceField& walls, const Points& points,
                       const std::vector<Candidate>& candidates, const Candidate& best) {
  UnsureAlong widest;
  for (const Candidate& other : candidates) {
    if (other.score < kUnsureShare * best.score) continue;
    if (IsElsewhere(other.map_from_first, best.map_from_first)) continue;
    const Eigen::Vector2d off =
        other.map_from_first.translation() - best.map_from_first.translation();
    if (off.norm() <= widest.reach_m) continue;
    widest = {std::atan2(off.y(), off.x()), off.norm()};
    if (widest.direction_rad < 0.0) widest.direction_rad += kPi;
  }
  for (int i = 0; i < 2 * kUnsureLines; ++i) {
    const double way_rad = kPi * i / kUnsureLines;
    const Eigen::Vector2d way(std::cos(way_rad), std::sin(way_rad));
    // As far as it goes without a break: what lies beyond one is another place.
    for (double off_m = kUnsureStepM; off_m <= kUnsureReachM; off_m += kUnsureStepM) {
      Pose2 pose = best.map_from_first;
      pose.x_m += off_m * way.x();
      pose.y_m += off_m * way.y();
      if (ScoreOf(walls, points, pose, kFineSigmaM) < kUnsureShare * best.score) break;
      if (off_m > widest.reach_m) widest = {std::fmod(way_rad, kPi), off_m};
    }
  }
  return widest;
}

}  // namespace

bool IsElsewhere(const Pose2& map_from_base, const Pose2& map_from_other) {
  return AreApart(map_from_base, map_from_other, kElsewhereM, kElsewhereRad);
}

std::optional<FoundPlace> FindPlaceNear(const OccupancyMap& map,
                                        const std::vector<PlacedScan>& scans,
                                        const Pose2& map_from_slam) {
  if (scans.empty()) return {};
  const DistanceField walls(map, kFarthestM);
  const Points points = PointsOf(scans, kPoints);
  if (!walls.any() || points.empty()) return {};
  const Pose2& slam_from_first = scans.front().slam_from_base;
  const Candidate place =
      NextTo(walls, PointsOf(scans, kCoarsePoints), points, map_from_slam * slam_from_first);
  return FoundPlace{place.map_from_first * Inverse(slam_from_first), place.score, 0.0, {}, {}};
}

std::optional<FoundPlace> FindPlace(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
                                    const Pose2& guess) {
  if (scans.empty()) return {};
  const DistanceField walls(map, kFarthestM);
  const Points points = PointsOf(scans, kPoints);
  if (!walls.any() || points.empty()) return {};
  std::vector<Candidate> candidates;
  const Points coarse_points = PointsOf(scans, kCoarsePoints);
  for (const Candidate& coarse : Coarse(map, walls, coarse_points)) {
    candidates.push_back(Refined(walls, points, coarse.map_from_first));
  }
  const Pose2& slam_from_first = scans.front().slam_from_base;
  const Candidate guessed = NearGuess(walls, coarse_points, points, guess * slam_from_first);
  Candidate best = guessed;
  for (const Candidate& candidate : candidates) {
    if (candidate.score > best.score) best = candidate;
  }
  if (guessed.score >= kGuessShare * best.score) best = guessed;
  FoundPlace found{best.map_from_first * Inverse(slam_from_first), best.score, 0.0, {}, {}};
  for (const Pose2& other : OthersThan(best, candidates)) {
    found.others.push_back(other * Inverse(slam_from_first));
  }
  const UnsureAlong unsure = UnsureLine(walls, points, candidates, best);
  if (unsure.reach_m >= kLeastUnsureM) found.unsure = unsure;
  for (const Candidate& candidate : candidates) {
    if (IsElsewhere(candidate.map_from_first, best.map_from_first)) {
      found.second_score = std::max(found.second_score, candidate.score);
    }
  }
  return found;
}

}  // namespace depthgrid
