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
#include "mapper/stage_timer.h"

namespace depthgrid {

struct MapperResult {
  // Per input frame, in input order: the final estimate; empty where neither SLAM nor the map knew
  // a pose.
  std::vector<std::optional<Pose3>> map_from_camera;
  std::vector<MappedFrame> mapped;  // what the map was drawn from, at final poses
  std::vector<PlanarLoop> loops;    // those that entered the graph
  OccupancyMap map;
};

// For fusion.mode `oracle`: the gain per base axis (forward, left, yaw) that an experiment which
// knows the truth wants for a frame.
using GainOracle = std::function<Eigen::Vector3d(int frame, const Pose2& predicted_map_from_base,
                                                 const Pose2& matched_map_from_base)>;

// The true pose of a frame in the map, for experiments that put it in place of the matched one;
// what the match says of its own sureness stays.
using MatchOracle = std::function<Pose2(int frame)>;

// A finished map to go on from.
struct PriorMap {
  // In order of time, at final poses; their `frame` is below 0.
  std::vector<MappedFrame> frames;
  // Where the new SLAM poses' frame lies in the map, to a few centimetres and degrees.
  Pose2 map_from_slam;
  // Localise only: nothing is inserted, no pose and no cell of the prior map changes.
  bool fixed = false;
};

class IncrementalMapper {
 public:
  // The camera may be absent when every frame brings a ready scan. Throws InputError for options
  // that contradict each other.
  IncrementalMapper(const MapperOptions& options, const std::optional<PinholeCamera>& camera,
                    CpuClock clock = {}, GainOracle oracle = {});
  ~IncrementalMapper();
  IncrementalMapper(IncrementalMapper&&) noexcept;

  // From the next frame on.
  void SetMatchOracle(MatchOracle oracle);

  // Before the first frame. The result's `mapped` then begins with the prior frames.
  void StartFrom(PriorMap prior);

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
