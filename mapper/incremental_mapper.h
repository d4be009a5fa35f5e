// The paper's Fig. 1 as a class: frames in, one report each, a corrected map and trajectory out.
#pragma once

#include <functional>
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

// Microseconds of CPU time. Only FrameReport::times depends on it; without one they stay zero.
using CpuClock = std::function<double()>;

class IncrementalMapper {
 public:
  // The camera may be absent when every frame brings a ready scan. Throws InputError for options
  // that contradict each other.
  IncrementalMapper(const MapperOptions& options, const std::optional<PinholeCamera>& camera,
                    CpuClock clock = {});
  ~IncrementalMapper();
  IncrementalMapper(IncrementalMapper&&) noexcept;

  FrameReport AddFrame(const Frame& frame);
  // The last correction, then the map drawn from the stored scans at their final poses.
  // `slam_final`, one a frame given or empty: SLAM's own final trajectory. It is the final estimate
  // when SLAM is trusted alone (K = 0); frames without one keep their live pose.
  MapperResult Finish(const std::vector<std::optional<Pose3>>& slam_final = {});
  // The map as it is known now.
  OccupancyMap CurrentMap() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid
