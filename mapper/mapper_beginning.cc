// Once the first adjustment tells how SLAM errs, the first frames are mapped anew with that in mind
// (docs/math.md, "The first frames again").
#include <utility>

#include "mapper/mapper_state.h"

namespace depthgrid {

// `newest` has begun, but is not placed yet.
void IncrementalMapper::State::GoThroughAgain(const Frame& newest,
                                              const std::optional<MotionSpread>& spread) {
  State again(options, camera, clocks, oracle);
  again.beginning.End();
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
  if (spread) again.AdjustBetweenFrames();
  // These know nothing of poses in the map.
  again.scanner = std::move(scanner);
  again.moving = std::move(moving);
  again.stands = std::move(stands);
  again.rounds = rounds;
  again.first_spread = spread;
  again.beginning = std::move(beginning);
  *this = std::move(again);
}

// What was drawn though it moves carries the map along until it is left out: of the first frames it
// is taken out once that shows.
void IncrementalMapper::State::TakeOutMistaken(const Frame& newest) {
  bool any = false;
  for (const std::vector<MovingObjects::Beams>& object : moving.TakeMistaken()) {
    any = beginning.TakeOut(object) || any;
  }
  if (any) GoThroughAgain(newest, first_spread);
  if (!AwaitsSpread() && !moving.MayBeMistaken()) beginning.End();
}

}  // namespace depthgrid
