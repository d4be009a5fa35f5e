// Joins what a finished map shows twice (docs/math.md, "Walls drawn twice" and "Torn maps").
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapper/core/reference_map.h"
#include "mapper/graph/guessed_part.h"
#include "mapper/grid/crossed_walls.h"
#include "mapper/grid/grid_options.h"
#include "mapper/loop_closing.h"

namespace depthgrid {

// A map whose scans are to lead through as few of its own walls as possible.
struct JoinedMap {
  std::vector<MappedFrame> frames;
  std::vector<PlanarLoop> loops;
  OccupancyMap map;
  std::vector<CrossedWalls> crossed;     // sampled
  std::optional<Adjustment> adjustment;  // that led to these poses, with these loops
  bool mended = false;                   // whether it began at poses other than the run's

  double share() const { return CrossingShare(crossed); }
};

class MapJoining {
 public:
  // `reference`: of all frames, as inserted. Between losses of SLAM, `guessed` parts are not
  // joined.
  MapJoining(const LoopOptions& options, const GridOptions& grid, ReferenceMap& reference,
             std::vector<GuessedPart> guessed)
      : options_(options), grid_(grid), reference_(reference), guessed_(std::move(guessed)) {}

  JoinedMap Examined(std::vector<MappedFrame> frames, std::vector<PlanarLoop> loops) const;
  // Empty if nothing was joined, or if that left more than half of what it led through.
  std::optional<JoinedMap> Joined(const JoinedMap& map) const;

 private:
  std::optional<JoinedMap> JoinedByPlace(const JoinedMap& map) const;
  std::optional<JoinedMap> JoinedByPart(const JoinedMap& map) const;
  std::optional<JoinedMap> JoinedWith(const PlanarLoop& loop, const JoinedMap& map,
                                      std::span<const AdjustEffort> efforts) const;

  const LoopOptions& options_;
  const GridOptions& grid_;
  ReferenceMap& reference_;
  std::vector<GuessedPart> guessed_;
};

}  // namespace depthgrid
