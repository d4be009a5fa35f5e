#include "mapper/match/find_place.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "mapper/core/angle.h"
#include "mapper/match/distance_field.h"
#include "mapper/match/place_lattice.h"

namespace depthgrid {
namespace {

// Number of returns used, spread over the scans: enough to distinguish rooms, few enough to try
// some million places.
constexpr std::size_t kPoints = 320;
constexpr std::size_t kCoarsePoints = 64;
// The score of a return falls to exp(-1/2) at this distance from a wall (kCoarseSigmaM in the
// coarse search).
constexpr double kFineSigmaM = 0.06;
constexpr double kFarthestM = 0.6;
// Places this near to each other count as one.
constexpr double kApartM = 0.3;
constexpr double kApartRad = RadFromDeg(8.0);
constexpr double kOtherShare = 0.8;
constexpr std::size_t kMostOthers = 7;
// A refinement starts with half the lattice's steps; the last ones are 1.6 mm and 0.06 degrees.
constexpr double kFirstStepM = 0.05;
constexpr double kFirstStepRad = RadFromDeg(2.0);
constexpr int kHalvings = 5;
constexpr double kElsewhereM = 1.0;
constexpr double kElsewhereRad = RadFromDeg(30.0);
// A place near the guess (within SLAM's drift since the map was made) is preferred if it has this
// share of the best score.
constexpr double kGuessShare = 0.9;
constexpr double kGuessReachRad = RadFromDeg(12.0);
constexpr double kGuessStepM = 0.15;
constexpr double kGuessStepRad = RadFromDeg(4.0);
constexpr std::size_t kGuessesRefined = 10;
// Poses with this share of the best score may be the place as well; they are searched along
// kUnsureLines lines.
constexpr double kUnsureShare = 0.97;
constexpr int kUnsureLines = 36;  // 5 degrees apart: at 1 m half of that is 4 cm across
constexpr double kUnsureStepM = 0.05;
constexpr double kUnsureReachM = 5.0;
// Less uncertainty than this is resolved by matching: of 40 starts in two rooms, those correct to 2
// cm had at most 0.16 m, except four for which another place fitted nearly as well.
constexpr double kLeastUnsureM = 0.2;

// About `wanted` evenly chosen returns of all scans, in base axes of the first scan.
PlaceReturns PointsOf(const std::vector<PlacedScan>& scans, std::size_t wanted) {
  PlaceReturns all;
  const Pose2 first_from_slam = Inverse(scans.front().slam_from_base);
  for (const PlacedScan& placed : scans) {
    const Pose2 first_from_base = first_from_slam * placed.slam_from_base;
    for (const Beam& beam : placed.scan->beams) {
      if (!beam.hit) continue;
      all.push_back({first_from_base.translation(), first_from_base * EndPoint(beam)});
    }
  }
  PlaceReturns chosen;
  for (std::size_t i = 0; i < wanted && !all.empty(); ++i) {
    chosen.push_back(all[i * all.size() / wanted]);
  }
  return chosen;
}

double ScoreOf(const DistanceField& walls, const PlaceReturns& points, const Pose2& map_from_first,
               double sigma_m) {
  const double c = std::cos(map_from_first.yaw_rad);
  const double s = std::sin(map_from_first.yaw_rad);
  double sum = 0.0;
  const auto in_map = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(map_from_first.x_m + c * p.x() - s * p.y(),
                           map_from_first.y_m + s * p.x() + c * p.y());
  };
  for (const PlaceReturn& point : points) {
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

// Coordinate search: steps along each axis, halved when none improves the score.
PlaceCandidate Refined(const DistanceField& walls, const PlaceReturns& points, const Pose2& start) {
  PlaceCandidate best{start, ScoreOf(walls, points, start, kFineSigmaM)};
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
PlaceCandidate NearGuess(const DistanceField& walls, const PlaceReturns& coarse_points,
                         const PlaceReturns& points, const Pose2& guess, double reach_m) {
  std::vector<PlaceCandidate> around;
  const int steps = static_cast<int>(reach_m / kGuessStepM);
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
  std::stable_sort(
      around.begin(), around.end(),
      [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.score > b.score; });
  PlaceCandidate best = Refined(walls, points, guess);
  for (std::size_t i = 0; i < std::min(kGuessesRefined, around.size()); ++i) {
    const PlaceCandidate refined = Refined(walls, points, around[i].map_from_first);
    if (refined.score > best.score) best = refined;
  }
  return best;
}

// The place nearest to `known`, unless another within reach is much better: keeps the prior where
// little is seen, as along a corridor. `known` itself if it fits as well.
PlaceCandidate NextTo(const DistanceField& walls, const PlaceReturns& coarse_points,
                      const PlaceReturns& points, const Pose2& known, double within_m) {
  const PlaceCandidate given{known, ScoreOf(walls, points, known, kFineSigmaM)};
  if (within_m == 0.0) return given;
  const auto is_within = [&](const PlaceCandidate& place) {
    return (place.map_from_first.translation() - known.translation()).norm() <= within_m;
  };
  const PlaceCandidate next = Refined(walls, points, known);
  const PlaceCandidate best = NearGuess(walls, coarse_points, points, known, within_m);
  PlaceCandidate place = next.score >= kGuessShare * best.score ? next : best;
  if (!is_within(place)) place = is_within(next) ? next : given;
  return FitsAsWell(given.score, place.score) ? given : place;
}

// Other candidates that may be the place, best first.
std::vector<Pose2> OthersThan(const PlaceCandidate& best, std::vector<PlaceCandidate> candidates) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.score > b.score; });
  std::vector<Pose2> others;
  for (const PlaceCandidate& candidate : candidates) {
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

// The line through the place along which the score stays high farthest, and how far to either side.
UnsureAlong UnsureLine(const DistanceField& walls, const PlaceReturns& points,
                       const std::vector<PlaceCandidate>& candidates, const PlaceCandidate& best) {
  UnsureAlong widest;
  for (const PlaceCandidate& other : candidates) {
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
    // Only up to the first drop: what lies beyond it is another place.
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

bool FitsAsWell(double score, double best_score) { return score >= kUnsureShare * best_score; }

double FitAt(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
             const Pose2& map_from_slam) {
  const PlaceReturns points = PointsOf(scans, kPoints);
  if (points.empty()) return 0.0;
  const Pose2 map_from_first = map_from_slam * scans.front().slam_from_base;
  return ScoreOf(DistanceField(map, kFarthestM), points, map_from_first, kFineSigmaM);
}

std::optional<FoundPlace> FindPlaceNear(const OccupancyMap& map,
                                        const std::vector<PlacedScan>& scans,
                                        const Pose2& map_from_slam, double within_m) {
  if (scans.empty()) return {};
  const DistanceField walls(map, kFarthestM);
  const PlaceReturns points = PointsOf(scans, kPoints);
  if (!walls.any() || points.empty()) return {};
  const Pose2& slam_from_first = scans.front().slam_from_base;
  const PlaceCandidate place = NextTo(walls, PointsOf(scans, kCoarsePoints), points,
                                      map_from_slam * slam_from_first, within_m);
  return FoundPlace{place.map_from_first * Inverse(slam_from_first), place.score, 0.0, {}, {}, {}};
}

std::optional<FoundPlace> FindPlace(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
                                    const Pose2& guess) {
  if (scans.empty()) return {};
  const DistanceField walls(map, kFarthestM);
  const PlaceReturns points = PointsOf(scans, kPoints);
  if (!walls.any() || points.empty()) return {};
  std::vector<PlaceCandidate> candidates;
  const PlaceReturns coarse_points = PointsOf(scans, kCoarsePoints);
  for (const PlaceCandidate& coarse : BestOnLattice(map, walls, coarse_points)) {
    candidates.push_back(Refined(walls, points, coarse.map_from_first));
  }
  const Pose2& slam_from_first = scans.front().slam_from_base;
  const PlaceCandidate guessed =
      NearGuess(walls, coarse_points, points, guess * slam_from_first, kKnownWithinM);
  PlaceCandidate best = guessed;
  for (const PlaceCandidate& candidate : candidates) {
    if (candidate.score > best.score) best = candidate;
  }
  if (guessed.score >= kGuessShare * best.score) best = guessed;
  FoundPlace found{best.map_from_first * Inverse(slam_from_first), best.score, 0.0, {}, {}, {}};
  for (const Pose2& other : OthersThan(best, candidates)) {
    found.others.push_back(other * Inverse(slam_from_first));
  }
  const UnsureAlong unsure = UnsureLine(walls, points, candidates, best);
  if (unsure.reach_m >= kLeastUnsureM) found.unsure = unsure;
  for (const PlaceCandidate& candidate : candidates) {
    if (!IsElsewhere(candidate.map_from_first, best.map_from_first)) continue;
    if (candidate.score <= found.second_score) continue;
    found.second_score = candidate.score;
    found.second = candidate.map_from_first * Inverse(slam_from_first);
  }
  return found;
}

}  // namespace depthgrid
