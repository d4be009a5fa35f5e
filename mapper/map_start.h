// Finds where in a finished map a sequence begins (docs/formats.md, "Going on in a finished map").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/incremental_mapper.h"
#include "mapper/match/find_place.h"

namespace depthgrid {

// Result of mapping the next frames from several candidate places. Agreement is
// MapAgreement::share(), a / (a + c + b / 10), where of b beams a end on a wall of the map and c in
// free space or behind a wall.
struct StartTrial {
  int places = 0;
  int frames = 0;
  double reach_m = 0.0;         // greatest distance of SLAM's poses from the first one
  double agreement = 0.0;       // 0..1, of the place chosen
  double agreement_next = 0.0;  // of the best place that led elsewhere
  double against = 0.0;         // c / (a + c), of the place chosen
};

// Limit on StartTrial::against; more means another place. None of 68 right starts had more than
// 0.21, 61 of 81 wrong ones had (docs/formats.md, "Going on in a finished map").
constexpr double kMuchAgainst = 0.25;

struct MapStart {
  FoundPlace place;
  std::optional<StartTrial> trial;  // empty where SLAM is trusted alone
  bool known = false;               // from FindStartNear(), which searches nearby only
  Pose2 map_from_base;              // of the first frame with a pose and a scan

  // Whether the place is ambiguous: another one is nearly as good, or fits_badly(), or
  // hardly_moved() with doubts.
  bool uncertain() const;
  // Little of what was seen agrees with the map.
  bool fits_badly() const;
  // The robot moved less than a metre and saw one viewpoint only, so limits are stricter: the place
  // is uncertain if `place.unsure` is set, too.
  bool hardly_moved() const;
  // Much of what was seen contradicts the map at any place: it is another building, outside the
  // map, or much has changed.
  bool contradicted() const;
};

// Matches the first views of `source` (first 3 m) with the whole map, then localises the first
// metres from each candidate place and takes the one with the best agreement; localising backwards
// from the end refines the start. Empty when no scan has a return. `prior.map_from_slam` is
// ignored; the result's place.map_from_slam is its value. Reads the first 3 m of the source,
// however long the robot stands before, then up to 6 m more or 400 frames in all. Takes about a
// second, two for a map of 10,000 scans. Throws InputError as StartFrom() and AddFrame() do.
std::optional<MapStart> FindStart(const PriorMap& prior, FrameSource& source,
                                  const MapperOptions& options);
// The same with collected first frames of a live robot; the more of those 9 m they cover, the more
// certain the place. `camera` is that of their depth images.
std::optional<MapStart> FindStart(const PriorMap& prior, const std::vector<Frame>& first_frames,
                                  const std::optional<PinholeCamera>& camera,
                                  const MapperOptions& options);

// The same with a known place, such as Nav2's initial pose: `map_from_base` is the base's (or
// laser's) pose at the first frame with a pose and a scan, accurate to `within_m` (0 to
// kMostWithinM) and 12 degrees. Throws InputError for other values, or a pose that is not finite or
// beyond 10,000 km. The pose is refined unless the scans fit there about as well; with 0 it is
// taken as it is. See uncertain() and contradicted() for whether the scans fit.
std::optional<MapStart> FindStartNear(const PriorMap& prior, const Pose2& map_from_base,
                                      FrameSource& source, const MapperOptions& options,
                                      double within_m = kKnownWithinM);
std::optional<MapStart> FindStartNear(const PriorMap& prior, const Pose2& map_from_base,
                                      const std::vector<Frame>& first_frames,
                                      const std::optional<PinholeCamera>& camera,
                                      const MapperOptions& options,
                                      double within_m = kKnownWithinM);

}  // namespace depthgrid
