// The end of a run: final adjustment and drawing of the map.
#include <utility>

#include "mapper/astray_mending.h"
#include "mapper/core/level.h"
#include "mapper/finished_map.h"
#include "mapper/frame_check.h"
#include "mapper/map_joining.h"
#include "mapper/mapper_state.h"

namespace depthgrid {

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
  for (const AstrayPart& part : final.astray) {
    result.astray.push_back({frame(part.first), frame(part.last), part.apart_m, part.usual_m});
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

// Without those that are only kept to find the place in a finished map.
std::vector<MappedFrame> IncrementalMapper::State::FramesOfMap() const {
  std::vector<MappedFrame> frames = mapped.all();
  if (fixed_map) frames.resize(static_cast<std::size_t>(prior_frames));
  return frames;
}

IncrementalMapper::State::FinalEstimate IncrementalMapper::State::FinalAsItIs() const {
  FinalEstimate final;
  final.map_from_base = PosesOf(mapped.all());
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
  PutRight(final);
  final.guessed = relocation.GuessedParts(mapped.size());
  std::erase_if(final.guessed,
                [&](const GuessedPart& part) { return IsLeftByAny(part, final.loops); });
  final.loops = AmongKept(std::move(final.loops), mapped.all());
  final.map_from_camera = FinalPoses(history, final.map_from_base, stands);
  return final;
}

void IncrementalMapper::State::PutRight(FinalEstimate& final) const {
  const bool mends = options.loops.astray_ratio > 0.0 && options.method == MapperMethod::kSurfel;
  const bool joins = options.loops.join_doubled;
  if (!options.loops.use || !loop_search || !(mends || joins)) return;
  const MapJoining joining(options.loops, options.grid, *reference,
                           relocation.GuessedParts(mapped.size()));
  JoinedMap map =
      joining.Examined(WithPoses(mapped.all(), final.map_from_base), loop_closer.loops());
  if (mends) {
    AstrayMending mending(options.loops, joining, *reference);
    map = mending.Mended(std::move(map));
    final.astray = mending.undecided();
  }
  if (joins) {
    if (std::optional<JoinedMap> joined = joining.Joined(map)) map = std::move(*joined);
  }
  if (map.adjustment) {
    final.loops = Held(map.loops, *map.adjustment);
    final.map_from_base = std::move(map.adjustment->map_from_base);
  }
  final.map = std::move(map.map);
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
  return KeptFrames(state_->FramesOfMap(), PosesOf(state_->mapped.all()));
}

OccupancyMap IncrementalMapper::State::Draw(const std::vector<MappedFrame>& frames) const {
  return DrawKept(frames, options.grid);
}

}  // namespace depthgrid
