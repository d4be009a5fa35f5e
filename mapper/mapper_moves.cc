// Moves what was mapped, and tells what was moved.
#include "mapper/mapper_state.h"

namespace depthgrid {

// Moves all frames mapped from index `first` on, rigidly.
void IncrementalMapper::State::MovePart(int first, const Pose2& motion) {
  std::vector<Pose2> map_from_base;
  for (int i = 0; i < mapped.size(); ++i) {
    const Pose2& pose = mapped.all()[static_cast<std::size_t>(i)].map_from_base;
    map_from_base.push_back(i < first ? pose : motion * pose);
  }
  mapped.ForgetMotionTo(first);
  MoveTo(map_from_base, {}, first);
  // What these collect lies where the part was.
  slides.Forget();
  if (loop_search) loop_search->Forget();
}

// Moves all frames mapped since the loss once the search has found their place.
void IncrementalMapper::State::Relocate(const FrameScans& scans, FrameReport& report) {
  const StageTimer timer(clocks, report.times.loops_us);
  if (!relocation.unsettled() || !(report.inserted || report.well_seen)) return;
  const std::optional<Pose2> moved = relocation.Find(mapped.all(), scans.matched, *reference);
  report.relocated = moved && !relocation.IsGuess(*moved, mapped.all());
  if (fixed_map) {
    if (!relocation.unsettled()) SettleInFixed(moved.value_or(Pose2{}));
  } else if (moved) {
    MovePart(relocation.first_frame(), *moved);
  }
}

// Before the end of a run, if where the newest part lies is still a guess.
void IncrementalMapper::State::RelocateAtLast() {
  if (!relocation.unsettled() || mapped.size() <= relocation.first_frame()) return;
  const std::optional<Pose2> moved = relocation.FindAtLast(mapped.all());
  if (!moved) return;
  if (fixed_map) {
    SettleInFixed(*moved);
  } else {
    MovePart(relocation.first_frame(), *moved);
  }
}

// The place in a finished map is known again: the poses since the loss move there.
void IncrementalMapper::State::SettleInFixed(const Pose2& motion) {
  history.Unmap(FrameAt(mapped.all(), prior_frames).frame, motion);
  filter.SetCorrection(motion * filter.map_from_slam());
  ForgetGuess();
}

// Lost again in a finished map before the place was known.
void IncrementalMapper::State::GiveGuessUp() {
  const int first = FrameAt(mapped.all(), prior_frames).frame;
  given_up.push_back({first, mapped.back().frame});
  history.Unmap(first, {});
  ForgetGuess();
}

// What was mapped at a guess is no part of a finished map, and is not matched any more.
void IncrementalMapper::State::ForgetGuess() {
  mapped.CutAt(prior_frames);
  reference = MakeReference(options);
  InsertPrior();
  errors.Break();
  errors.Adjusted({}, filter.step().new_bias);
}

// Sets corrected poses; the filter's correction follows the newest mapped frame.
void IncrementalMapper::State::MoveTo(const std::vector<Pose2>& map_from_base,
                                      const Eigen::MatrixXd& covariance,
                                      const std::optional<int>& moved_apart) {
  const Pose2 before = mapped.back().map_from_base;
  moves.Append(mapped.MoveTo(map_from_base));
  if (moved_apart) {
    reference->RebuildMoved(mapped.all(), *moved_apart);
  } else {
    reference->Rebuild(mapped.all());
  }
  const FrameRecord& record = *history.Find(mapped.back().frame);
  const Pose2& after = mapped.back().map_from_base;
  if (filter_epoch == record.epoch) {
    filter.SetCorrection(after * Inverse(BaseOf(*record.slam_from_camera)));
  } else {  // a newer epoch began with frames without a scan: move along
    filter.SetCorrection(after * Inverse(before) * filter.map_from_slam());
  }
  errors.Break();
  errors.Adjusted(covariance, filter.step().new_bias);
}

// Of two maps of the same frames, the second one with them mapped again.
FrameMoves IncrementalMapper::State::MovesTo(const State& again) const {
  FrameMoves moves_to;
  for (const MappedFrame& frame : mapped.all()) {
    const int position = again.history.Find(frame.frame)->mapped;
    if (position < 0) continue;
    moves_to.Include(frame.map_from_base, FrameAt(again.mapped.all(), position).map_from_base);
  }
  return moves_to;
}

void IncrementalMapper::State::TellCorrections(FrameReport& report) const {
  report.map_moved_m = moves.most_m;
  report.map_turned_rad = moves.most_rad;
  report.map_corrected = report.map_corrected || moves.any();
  report.map_from_slam = prior_start.value_or(filter.map_from_slam());
}

}  // namespace depthgrid
