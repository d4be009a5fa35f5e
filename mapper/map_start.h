// Where in a finished map a sequence begins (docs/formats.md, "Going on in a finished map").
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/incremental_mapper.h"
#include "mapper/match/find_place.h"

namespace depthgrid {

// How well what was seen next, over so many frames, agreed with the map from several places on:
// a / (a + c + b / 10), where of b beams a end on a wall of the map, and c where it is free or
// beyond a wall. What the map does not know counts little.
struct StartTrial {
  int places = 0;
  int frames = 0;
  double reach_m = 0.0;         // how far SLAM's poses lead from where they began
  double agreement = 0.0;       // 0..1, of the place chosen
  double agreement_next = 0.0;  // of the best one that led elsewhere
  double against = 0.0;         // c / (a + c), of the place chosen
};

// Of what contradicts the map or lies on its walls: more of it says that it is another place. None
// of 68 right starts had more than 0.21, 61 of 81 wrong ones had (docs/formats.md, "Going on in a
// finished map").
constexpr double kMuchAgainst = 0.25;

struct MapStart {
  FoundPlace place;
  std::optional<StartTrial> trial;  // empty where SLAM is trusted alone
  bool known = false;               // FindStartNear() was told where, and only looked nearby
  Pose2 map_from_base;              // of the first frame that has a pose and a scan

  // Whether the place is a guess: another one is nearly as good, or one of these:
  bool uncertain() const;
  // Little of what was seen lies on the map.
  bool fits_badly() const;
  // The robot stood or went less than a metre. It has looked from one place, so more is asked for:
  // it is uncertain as well where `place.unsure` is not empty.
  bool hardly_moved() const;
  // Whether much of what was seen contradicts the map wherever it is placed: it is of another
  // place, begins outside of the map, or much has changed.
  bool contradicted() const;
};

// The first views of `source` (of its first 3 m) are laid over the whole map. From each place where
// they fit the first metres are placed in it, and the one from which they agree with it best is
// taken; the way back tells where exactly they began. Nothing when no scan shows anything.
// `prior.map_from_slam` does not count: the place found is what it is to be. Of the source the
// first 3 m are read, however long the robot stands before, and then 6 m more, or up to 400 frames
// in all. It takes a second, and more of large maps. Throws InputError as StartFrom() and
// AddFrame() do.
std::optional<MapStart> FindStart(const PriorMap& prior, FrameSource& source,
                                  const MapperOptions& options);
// The same of the first frames of a live robot, collected until there is a mapper to give them to:
// the more of those 9 m they show, the surer the place. `camera` is that of their depth images.
std::optional<MapStart> FindStart(const PriorMap& prior, const std::vector<Frame>& first_frames,
                                  const std::optional<PinholeCamera>& camera,
                                  const MapperOptions& options);

// Where it is known: `map_from_base` is the base's place in the map (that of the scans, a laser's
// own) at the first frame that has a pose and a scan, to `within_m` metres, 0 to kMostWithinM, and
// 12 degrees (InputError for others, or a pose that is not finite or beyond 10,000 km), as a
// user of Nav2 gives it. It is made exact by what is seen, unless that fits there about as well; 0
// takes it as it is. Whether what is seen fits, uncertain() and contradicted() say.
std::optional<MapStart> FindStartNear(const PriorMap& prior, const Pose2& map_from_base,
                                      FrameSource& source, const MapperOptions& options,
                                      double within_m = kKnownWithinM);
std::optional<MapStart> FindStartNear(const PriorMap& prior, const Pose2& map_from_base,
                                      const std::vector<Frame>& first_frames,
                                      const std::optional<PinholeCamera>& camera,
                                      const MapperOptions& options,
                                      double within_m = kKnownWithinM);

}  // namespace depthgrid
