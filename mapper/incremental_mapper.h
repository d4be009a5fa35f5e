// The paper's Fig. 1 as a class: frames in, one report each, a corrected map and trajectory out.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/frame_report.h"
#include "mapper/mapper_options.h"
#include "mapper/reference_map.h"

namespace depthgrid {

struct MapperResult {
  // Per input frame, in input order: the final estimate; empty where neither SLAM nor the map knew
  // a pose.
  std::vector<std::optional<Pose3>> map_from_camera;
  std::vector<MappedFrame> mapped;  // what the map was drawn from, at final poses
  std::vector<PlanarLoop> loops;    // those that entered the graph
  OccupancyMap map;
};

class IncrementalMapper {
 public:
  // The camera may be absent when every frame brings a ready scan. Throws InputError for options
  // that contradict each other.
  IncrementalMapper(const MapperOptions& options, const std::optional<PinholeCamera>& camera);
  ~IncrementalMapper();
  IncrementalMapper(IncrementalMapper&&) noexcept;

  FrameReport AddFrame(const Frame& frame);
  // The last correction, then the map drawn from the stored scans at their final poses.
  MapperResult Finish();
  // The map as it is known now.
  OccupancyMap CurrentMap() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid
