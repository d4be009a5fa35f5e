// The end of a run: the last correction, and the map from the stored scans.
#include "mapper/core/error.h"
#include "mapper/core/level.h"
#include "mapper/grid/map_drawing.h"
#include "mapper/mapper_state.h"

namespace depthgrid {

MapperResult IncrementalMapper::Finish(const std::vector<std::optional<Pose3>>& slam_final) {
  const std::vector<FrameRecord>& records = state_->history.records();
  Require(slam_final.empty() || slam_final.size() == records.size(),
          "SLAM's final trajectory has one entry a frame");
  MapperResult result;
  std::vector<Pose2> map_from_base;
  for (const MappedFrame& frame : state_->mapped.all()) {
    map_from_base.push_back(frame.map_from_base);
  }
  if (state_->fixed_map || (state_->prior_frames > 0 && !state_->reference)) {
    result.map_from_camera = FinalPoses(state_->history, map_from_base, state_->stands);
  } else if (state_->reference) {
    map_from_base = state_->FinishByAdjusting(result);
  } else {
    state_->FinishWithSlam(slam_final, result, map_from_base);
  }
  result.mapped = KeptFrames(state_->mapped.all(), map_from_base);
  result.map = state_->Draw(result.mapped);
  return result;
}

std::vector<Pose2> IncrementalMapper::State::FinishByAdjusting(MapperResult& result) const {
  if (mapped.empty()) {  // ended before the first image that came with a pose
    result.map_from_camera = FinalPoses(history, {}, stands);
    return {};
  }
  Adjustment adjustment = loop_closer.AdjustAll(mapped.all(), *reference, AdjustEffort::kFinish);
  for (std::size_t i = 0; i < loop_closer.loops().size(); ++i) {
    if (adjustment.loop_accepted[i]) result.loops.push_back(loop_closer.loops()[i]);
  }
  result.loops = AmongKept(std::move(result.loops), mapped.all());
  result.map_from_camera = FinalPoses(history, adjustment.map_from_base, stands);
  return std::move(adjustment.map_from_base);
}

void IncrementalMapper::State::FinishWithSlam(const std::vector<std::optional<Pose3>>& slam_final,
                                              MapperResult& result,
                                              std::vector<Pose2>& map_from_base) const {
  for (std::size_t i = 0; i < history.records().size(); ++i) {
    const FrameRecord& record = history.records()[i];
    const bool corrected = i < slam_final.size() && slam_final[i].has_value();
    result.map_from_camera.push_back(corrected ? slam_final[i] : record.slam_from_camera);
    if (record.mapped >= 0) {
      map_from_base[static_cast<std::size_t>(record.mapped)] =
          BaseOf(*result.map_from_camera.back());
    }
  }
}

OccupancyMap IncrementalMapper::CurrentMap() const { return state_->Draw(state_->mapped.all()); }

OccupancyMap IncrementalMapper::State::Draw(const std::vector<MappedFrame>& frames) const {
  MapDrawing drawing(options.grid);
  for (const MappedFrame& frame : frames) {
    if (frame.kept()) drawing.Add(*frame.obstacles, frame.map_from_base);
  }
  return drawing.Map();
}

}  // namespace depthgrid
