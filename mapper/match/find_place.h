// Where in a finished map a robot begins, when nobody says: a few scans of its first metres laid
// over the whole map.
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

// A line through the place along which what is seen fits nearly as well: a plain wall.
struct UnsureAlong {
  double direction_rad = 0.0;  // in the map, 0 up to pi
  double reach_m = 0.0;        // how far off the place may be, either way
};

struct FoundPlace {
  Pose2 map_from_slam;
  // 1 where every return lies on a wall of the map and comes there through free space.
  double score = 0.0;
  // That of the best place elsewhere (1 m or 30 degrees away): near `score`, the place is a guess.
  double second_score = 0.0;
  // That place, the same as map_from_slam. Empty where there is none.
  std::optional<Pose2> second;
  // Empty where the place is known to 0.2 m in every direction, which matching makes exact.
  std::optional<UnsureAlong> unsure;
  // Of other places (0.3 m or 8 degrees apart) that fit 0.8 times as well or better, seven at most:
  // the same as map_from_slam, best first.
  std::vector<Pose2> others;
};

// Tries every free cell and heading, then refines the best. What is near to `guess` (SLAM's
// frame being the map's) wins when it is nearly as good. Nothing when the map has no wall, or the
// scans no return.
std::optional<FoundPlace> FindPlace(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
                                    const Pose2& guess);

// Whether two places are so far apart.
bool IsElsewhere(const Pose2& map_from_base, const Pose2& map_from_other);

// A place may be wrong by as much where nobody says how well it is known, and 12 degrees.
constexpr double kKnownWithinM = 1.5;
constexpr double kMostWithinM = 5.0;

// Where it is known already, to so many metres and 12 degrees: there, where the scans fit about as
// well as anywhere near, or the best place next to it. Nothing is said of others, nor how sure it
// is.
std::optional<FoundPlace> FindPlaceNear(const OccupancyMap& map,
                                        const std::vector<PlacedScan>& scans,
                                        const Pose2& map_from_slam,
                                        double within_m = kKnownWithinM);

// How well scans fit at a place, as FoundPlace::score; 0 where they have no return.
double FitAt(const OccupancyMap& map, const std::vector<PlacedScan>& scans,
             const Pose2& map_from_slam);

// Whether one fit may be that of the right place beside a better one.
bool FitsAsWell(double score, double best_score);

}  // namespace depthgrid
