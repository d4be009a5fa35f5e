// Global localisation in a finished map: lays a few scans of the robot's first metres over the
// whole map.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/occupancy_map.h"
#include "mapper/core/pose2.h"
#include "mapper/core/scan.h"

namespace depthgrid {

struct PlacedScan {
  std::shared_ptr<const Scan> scan;
  Pose2 slam_from_base;
};

// A direction in which the place could be shifted with nearly as good a fit, as along a plain wall.
struct UnsureAlong {
  double direction_rad = 0.0;  // in the map, 0 up to pi
  double reach_m = 0.0;        // possible shift either way
};

struct FoundPlace {
  Pose2 map_from_slam;
  // 1 if every return lies on a wall of the map and its beam passes through free space.
  double score = 0.0;
  // Score of the best other place (1 m or 30 degrees away): if close to `score`, the place is
  // ambiguous.
  double second_score = 0.0;
  // That place as map_from_slam; empty if there is none.
  std::optional<Pose2> second;
  // Empty if the place is determined to 0.2 m in every direction, enough for matching.
  std::optional<UnsureAlong> unsure;
  // Other places (0.3 m or 8 degrees apart) with at least 0.8 times the score, at most seven, as
  // map_from_slam, best first.
  std::vector<Pose2> others;
};

// Tries every free cell and heading, then refines the best. A place near `guess` (as map_from_slam)
// is preferred if nearly as good. Empty if the map has no wall or the scans have no return.
std::optional<FoundPlace> FindPlace(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
                                    const Pose2& guess);

// Whether two places differ by 1 m or 30 degrees.
bool IsElsewhere(const Pose2& map_from_base, const Pose2& map_from_other);

// Default and largest error (m) of a given place, beside 12 degrees.
constexpr double kKnownWithinM = 1.5;
constexpr double kMostWithinM = 5.0;

// Refines a place known to `within_m` and 12 degrees: keeps it if the scans fit about as well as
// anywhere near, else takes the best place near it. The other fields of FoundPlace are not filled.
std::optional<FoundPlace> FindPlaceNear(const OccupancyMap& map,
                                        const std::vector<PlacedScan>& scans,
                                        const Pose2& map_from_slam,
                                        double within_m = kKnownWithinM);

// FoundPlace::score of the scans at a place; 0 without returns.
double FitAt(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
             const Pose2& map_from_slam);

// Whether a place with `score` may be the right one although another has `best_score`.
bool FitsAsWell(double score, double best_score);

}  // namespace depthgrid
