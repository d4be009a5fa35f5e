// Maps the first frames again once the first adjustment gives SLAM's noise, and when an object that
// was drawn turns out to move (docs/math.md, "The first frames again" and "What moves").
#include <utility>

#include "mapper/mapper_state.h"

namespace depthgrid {

// Maps the first frames again. `newest` has been started but not placed yet.
void IncrementalMapper::State::GoThroughAgain(const Frame& newest,
                                              const std::optional<MotionSpread>& spread) {
  State again(options, camera, clocks, oracle);
  again.beginning.End();
  again.moved_on_frames = moved_on_frames;
  again.rounds = AdjustmentRounds({.first_frames = 0});
  if (spread) again.filter.BeginWith(filter, *spread);
  const auto begin = [&](const Frame& frame, FrameReport& report) {
    again.Begin(frame, report);
    again.history.newest().stand = history.Find(frame.index)->stand;
  };
  for (const Beginning::Seen& seen : beginning.frames()) {
    FrameReport report;
    begin(seen.frame, report);
    again.MapScans(seen.frame, seen.scans, report);
  }
  FrameReport report;
  begin(newest, report);
  if ((spread || rounds.any_was_due()) && !again.mapped.empty()) again.AdjustBetweenFrames();
  again.errors.Break();
  again.moves = moves;
  again.moves.Append(MovesTo(again));
  // These do not depend on poses in the map.
  again.held = std::move(held);
  again.frozen = std::move(frozen);
  again.scanner = std::move(scanner);
  again.moving = std::move(moving);
  again.moving.RenameEpoch(again.history.newest().epoch);  // slips may differ this time
  again.stands = std::move(stands);
  again.rounds = rounds;
  again.first_spread = spread;
  again.beginning = std::move(beginning);
  *this = std::move(again);
}

// Moving objects that were drawn distort the map: once detected, they are removed from the first
// frames, which are mapped again.
void IncrementalMapper::State::TakeOutMistaken(const Frame& newest, FrameReport& report) {
  bool any = false;
  for (const std::vector<MovingObjects::Sector>& object : moving.TakeMistaken()) {
    any = beginning.TakeOut(object) || any;
  }
  if (any) {
    const StageTimer timer(clocks, report.times.loops_us);
    GoThroughAgain(newest, first_spread);
    report.map_corrected = true;
  }
  if (!AwaitsSpread() && !moving.MayBeMistaken()) beginning.End();
}

}  // namespace depthgrid
