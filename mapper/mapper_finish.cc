// The end of a run: final adjustment and drawing of the map.
#include <utility>

#include "mapper/core/level.h"
#include "mapper/doubled_walls.h"
#include "mapper/finished_map.h"
#include "mapper/frame_check.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/mapper_state.h"

namespace depthgrid {
namespace {

// Joins made in one map at most, and the share of the crossing beams that one may leave.
constexpr int kMostJoins = 4;
constexpr double kJoinedShare = 0.5;

std::vector<MappedFrame> WithPoses(std::vector<MappedFrame> frames,
                                   const std::vector<Pose2>& map_from_base) {
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].map_from_base = map_from_base[i];
  return frames;
}

}  // namespace

MapperResult IncrementalMapper::Finish(const std::vector<std::optional<Pose3>>& slam_final) {
  const std::vector<FrameRecord>& records = state_->history.records();
  RequireSoundFinal(slam_final, records.size());
  state_->RelocateAtLast();
  State::FinalEstimate final = state_->Final(slam_final);
  MapperResult result;
  result.map_from_camera = std::move(final.map_from_camera);
  result.loops = std::move(final.loops);
  const std::vector<MappedFrame>& mapped_frames = state_->mapped.all();
  result.mapped = KeptFrames(state_->FramesOfMap(), final.map_from_base);
  result.guessed = state_->given_up;
  const auto frame = [&](int i) { return mapped_frames[static_cast<std::size_t>(i)].frame; };
  for (const GuessedPart& part : final.guessed) {
    const bool ends = part.end < static_cast<int>(mapped_frames.size());
    result.guessed.push_back(
        {frame(part.first), ends ? std::optional(frame(part.end - 1)) : std::nullopt});
  }
  const GridOptions& grid = state_->options.grid;
  result.map = final.map && !IsSharpened(result.mapped, grid) ? std::move(*final.map)
                                                              : DrawFinished(result.mapped, grid);
  return result;
}

IncrementalMapper::State::FinalEstimate IncrementalMapper::State::Final(
    const std::vector<std::optional<Pose3>>& slam_final) const {
  // With SLAM trusted alone in a prior map, its final poses are not in the map's frame.
  const bool stays = fixed_map || (has_prior && !reference);
  if (stays) return FinalAsItIs();
  if (!reference) return FinalOfSlam(slam_final);
  // mapped is empty if no image came with a pose.
  return mapped.empty() ? FinalAsItIs() : FinalByAdjusting();
}

std::vector<Pose2> IncrementalMapper::State::MappedPoses() const {
  std::vector<Pose2> map_from_base;
  for (const MappedFrame& frame : mapped.all()) map_from_base.push_back(frame.map_from_base);
  return map_from_base;
}

// Without those that are only kept to find the place in a finished map.
std::vector<MappedFrame> IncrementalMapper::State::FramesOfMap() const {
  std::vector<MappedFrame> frames = mapped.all();
  if (fixed_map) frames.resize(static_cast<std::size_t>(prior_frames));
  return frames;
}

IncrementalMapper::State::FinalEstimate IncrementalMapper::State::FinalAsItIs() const {
  FinalEstimate final;
  final.map_from_base = MappedPoses();
  final.guessed = relocation.GuessedParts(mapped.size());
  final.map_from_camera = FinalPoses(history, final.map_from_base, stands);
  return final;
}

IncrementalMapper::State::FinalEstimate IncrementalMapper::State::FinalByAdjusting() const {
  Adjustment adjustment =
      loop_closer.AdjustAll(mapped.all(), *reference, AdjustEffort::kFinish, {});
  FinalEstimate final;
  final.loops = Held(loop_closer.loops(), adjustment);
  final.map_from_base = std::move(adjustment.map_from_base);
  JoinDoubledWalls(final);
  final.guessed = relocation.GuessedParts(mapped.size());
  std::erase_if(final.guessed,
                [&](const GuessedPart& part) { return IsLeftByAny(part, final.loops); });
  final.loops = AmongKept(std::move(final.loops), mapped.all());
  final.map_from_camera = FinalPoses(history, final.map_from_base, stands);
  return final;
}

void IncrementalMapper::State::JoinDoubledWalls(FinalEstimate& final) const {
  if (!options.loops.join_doubled || !options.loops.use || !loop_search) return;
  std::vector<PlanarLoop> loops = loop_closer.loops();
  std::vector<MappedFrame> frames = WithPoses(mapped.all(), final.map_from_base);
  final.map = Draw(frames);
  std::vector<CrossedWalls> crossed = WallsCrossed(frames, *final.map, kDoubledSample);
  const std::vector<GuessedPart> guessed = relocation.GuessedParts(mapped.size());
  for (int joined = 0; joined < kMostJoins && CrossingShare(crossed) >= kDoubledShare; ++joined) {
    auto loop =
        LoopOfDoubledWalls(frames, crossed, options.loops.search, options.loops.overlap, guessed);
    if (!loop) return;
    loop->on_trial = true;
    loops.push_back(*loop);
    // The first one moves poses far, the second one is as accurate as the adjustment so far.
    Adjustment adjustment;
    for (const AdjustEffort effort : {AdjustEffort::kCloseLoops, AdjustEffort::kFinish}) {
      adjustment = reference->Adjust(frames, loops, effort, {});
      if (!adjustment.loop_accepted.back()) return;
      frames = WithPoses(std::move(frames), adjustment.map_from_base);
    }
    OccupancyMap map = Draw(frames);
    std::vector<CrossedWalls> remaining = WallsCrossed(frames, map, kDoubledSample);
    if (CrossingShare(remaining) > kJoinedShare * CrossingShare(crossed)) return;
    crossed = std::move(remaining);
    loops.back().on_trial = false;
    final.loops = Held(loops, adjustment);
    final.map_from_base = std::move(adjustment.map_from_base);
    final.map = std::move(map);
  }
}

IncrementalMapper::State::FinalEstimate IncrementalMapper::State::FinalOfSlam(
    const std::vector<std::optional<Pose3>>& slam_final) const {
  FinalEstimate final;
  final.map_from_base.resize(mapped.all().size());
  for (std::size_t i = 0; i < history.records().size(); ++i) {
    const FrameRecord& record = history.records()[i];
    const bool corrected = i < slam_final.size() && slam_final[i].has_value();
    final.map_from_camera.push_back(corrected ? slam_final[i] : record.slam_from_camera);
    if (record.mapped >= 0) {
      final.map_from_base[static_cast<std::size_t>(record.mapped)] =
          BaseOf(*final.map_from_camera.back());
    }
  }
  return final;
}

OccupancyMap IncrementalMapper::CurrentMap() const { return state_->Draw(state_->FramesOfMap()); }

std::vector<std::optional<Pose3>> IncrementalMapper::CurrentPoses() const {
  return state_->FinalAsItIs().map_from_camera;
}

std::vector<MappedFrame> IncrementalMapper::CurrentMapped() const {
  return KeptFrames(state_->FramesOfMap(), state_->MappedPoses());
}

OccupancyMap IncrementalMapper::State::Draw(const std::vector<MappedFrame>& frames) const {
  MapDrawing drawing(options.grid);
  for (const MappedFrame& frame : frames) {
    if (frame.kept()) drawing.Add(frame.frame, *frame.obstacles, frame.map_from_base);
  }
  return drawing.Map();
}

}  // namespace depthgrid
