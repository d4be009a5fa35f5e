#include "eval/doubts/way_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eval/doubts/stretches.h"
#include "mapper/core/angle.h"

namespace depthgrid {
namespace {

// In 36 runs of 450 frames (two shipped rooms, six profiles of SLAM, three seeds) the ratio was
// 0.87 to 1.10, except 0.77 for one with a broken map; depth read at a fifth of its scale gave
// 0.24.
constexpr double kMostRatio = 1.3;
constexpr double kLeastWayM = 2.0;

constexpr double kLeastTurnRad = 0.5 * kPi;
constexpr double kLeastScaledTurnRad = kPi;
// In about 40 logs of simulated lasers in a living room and an office, correct or with other
// faults, the ratio was 0.94 to 1.00; with the scans' angles scaled by 2/3 to 1.5 it was below 0.77
// or above 1.4.
constexpr double kMostTurnRatio = 1.15;
// Least cosine between the motions of SLAM and the map. For turns and translations it was 0.99 or
// more where all was correct; -1.00 and 0.93 for mirrored scans, -1.00 and 0.35 for headings with
// the wrong sign, 1.00 and 0.10 for swapped x and y (a laser in a living room).
constexpr double kSame = 0.5;

// Accumulates the cosine of the angle between two sequences of numbers; 1 where one is zero.
struct Likeness {
  double product = 0.0;
  double first = 0.0;
  double second = 0.0;

  void Add(double a, double b) {
    product += a * b;
    first += a * a;
    second += b * b;
  }
  double Cosine() const {
    const double lengths = std::sqrt(first * second);
    return lengths > 0.0 ? product / lengths : 1.0;
  }
};

}  // namespace

Ways WaysOf(const MappingRun& run) {
  Ways ways;
  const auto done = [](const Stretch& stretch) { return stretch.longer_m() >= kStretchM; };
  for (const Stretch& stretch : StretchesOf(run, done)) {
    ways.slam_m += stretch.slam.translation().norm();
    ways.map_m += stretch.map.translation().norm();
  }
  return ways;
}

std::optional<Ways> ScaleDoubt(const MappingRun& run) {
  const Ways ways = WaysOf(run);
  const auto [least_m, most_m] = std::minmax(ways.slam_m, ways.map_m);
  if (most_m < kLeastWayM || most_m < kMostRatio * least_m) return {};
  return ways;
}

std::optional<double> TurnScaleDoubt(const MappingRun& run) {
  const auto done = [](const Stretch& stretch) { return stretch.larger_turn_rad() >= kStretchRad; };
  Likeness turns;
  double turn_rad = 0.0;
  for (const Stretch& stretch : StretchesOf(run, done)) {
    turn_rad += stretch.larger_turn_rad();
    turns.Add(stretch.slam_turn_rad, stretch.map_turn_rad);
  }
  if (turn_rad < kLeastScaledTurnRad || turns.product <= 0.0) return {};
  // Noise in either sequence flattens the line that is fitted over it, so the true ratio lies
  // between the slope of the map over SLAM and that of SLAM over the map, turned round.
  const double least = turns.product / turns.first;
  const double most = turns.second / turns.product;
  const bool differs = most < 1.0 / kMostTurnRatio || least > kMostTurnRatio;
  return differs ? std::optional(std::sqrt(least * most)) : std::nullopt;
}

std::optional<WayFault> WayDoubt(const MappingRun& run) {
  Likeness turns, ways, mirrored_ways;
  double turn_rad = 0.0;
  double way_m = 0.0;
  for (const Stretch& stretch : WaysAndTurnsOf(run)) {
    const Pose2& slam = stretch.slam;
    const Pose2& map = stretch.map;
    turn_rad += stretch.larger_turn_rad();
    way_m += stretch.longer_m();
    turns.Add(stretch.slam_turn_rad, stretch.map_turn_rad);
    ways.Add(slam.x_m, map.x_m);
    ways.Add(slam.y_m, map.y_m);
    mirrored_ways.Add(slam.x_m, map.x_m);
    mirrored_ways.Add(-slam.y_m, map.y_m);
  }
  const bool turns_back = turn_rad >= kLeastTurnRad && turns.Cosine() < -kSame;
  const bool goes_astray = way_m >= kLeastWayM && ways.Cosine() < kSame;
  if (turns_back && mirrored_ways.Cosine() >= kSame) return WayFault::kMirroredScans;
  if (turns_back) return WayFault::kTurns;
  if (goes_astray) return WayFault::kDirections;
  return {};
}

}  // namespace depthgrid
