// Once the first adjustment tells how SLAM errs, the first frames are mapped anew with that in mind
// (docs/math.md, "The first frames again").
#include <utility>

#include "mapper/mapper_state.h"

namespace depthgrid {

// `newest` has begun, but is not placed yet.
void IncrementalMapper::State::GoThroughAgain(const Frame& newest, const MotionSpread& spread) {
  State again(options, camera, clocks, oracle);
  again.beginning.End();
  again.rounds = AdjustmentRounds({.first_frames = 0});
  again.filter.BeginWith(filter, spread);
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
  again.AdjustBetweenFrames();
  // These know nothing of poses in the map.
  again.scanner = std::move(scanner);
  again.moving = std::move(moving);
  again.stands = std::move(stands);
  again.rounds = rounds;
  *this = std::move(again);
}

}  // namespace depthgrid
