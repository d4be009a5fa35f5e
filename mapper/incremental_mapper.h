// The paper's Fig. 1 as a class: frames in, one report each, a corrected map and trajectory out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/core/frame_report.h"
#include "mapper/core/mapped_frame.h"
#include "mapper/core/occupancy_map.h"
#include "mapper/core/reference_map.h"
#include "mapper/frame_timer.h"
#include "mapper/mapper_options.h"

namespace depthgrid {

struct MapperResult {
  // Per frame that AddFrame() took, in that order (one it refused has no place here): the final
  // estimate; empty where neither SLAM nor the map knew a pose.
  std::vector<std::optional<Pose3>> map_from_camera;
  // What the map was drawn from, at final poses: the frames whose scans are kept.
  std::vector<MappedFrame> mapped;
  std::vector<PlanarLoop> loops;  // those that entered the graph
  OccupancyMap map;
};

// For fusion.mode `oracle`: the gain per base axis (forward, left, yaw) that an experiment which
// knows the truth wants for a frame.
using GainOracle = std::function<Eigen::Vector3d(int frame, const Pose2& predicted_map_from_base,
                                                 const Pose2& matched_map_from_base)>;

// The true pose of a frame in the map, for experiments that put it in place of the matched one;
// what the match says of its own sureness stays.
using MatchOracle = std::function<Pose2(int frame)>;

// A map to go on from.
struct PriorMap {
  // In order of time, at final poses, each with both its scans, which may be one; their `frame` is
  // below 0 and increases, by one within a drive: what a later drive saw counts more
  // (GridOptions::earlier_scans). WriteMapped() saves `mapped` of a result, or of a mapper that
  // runs, and ReadMapped() gives it back as this (mapper/io/mapped_files.h,
  // docs/examples/second_drive.cc); without a file PriorNumbers() counts it so
  // (mapper/core/drives.h). Of a frame its number, stamp, pose and scans are enough.
  std::vector<MappedFrame> frames;
  // Where the new SLAM poses' frame lies in the map, to a few centimetres and degrees; FindStart()
  // in mapper/map_start.h finds it. Nothing puts right one that is farther off.
  Pose2 map_from_slam;
  // Localise only: nothing is inserted, no pose and no cell of the prior map changes.
  bool fixed = false;
};

// Not for two threads at once; two mappers share nothing. Nothing is printed, no file touched, no
// thread started.
class IncrementalMapper {
 public:
  // `camera` is that of the depth images, without distortion; it may be absent when every frame
  // brings a ready scan. Throws InputError for a camera that is not sound and for options out of
  // range or that contradict each other.
  IncrementalMapper(const MapperOptions& options, const std::optional<PinholeCamera>& camera,
                    FrameClocks clocks = {}, GainOracle oracle = {});
  ~IncrementalMapper();
  // What was moved from may be destroyed or assigned to, nothing else.
  IncrementalMapper(IncrementalMapper&&) noexcept;
  IncrementalMapper& operator=(IncrementalMapper&&) noexcept;

  // From the next frame on.
  void SetMatchOracle(MatchOracle oracle);

  // Before the first frame, once. The result's `mapped` then begins with the prior frames. Throws
  // InputError, and nothing was begun, when it comes later or again, when a frame's number, pose,
  // stamp or scans are not as PriorMap wants them, a beam is none that CanBeKept(), or
  // `map_from_slam` is not finite or lies beyond 10,000 km. Method paper matches against the last
  // two submaps alone: `submap.scans` must be as many as the scans.
  void StartFrom(PriorMap prior);

  // Once a frame, in the order of time. Throws InputError, and then it is as if the frame had never
  // come, when
  // - its number is below 0 or was given before, or its stamp is not finite;
  // - its pose or a loop is not made of finite numbers: of a unit quaternion (to 0.001) within
  //   10,000 km, a sigma positive;
  // - its image is not the camera's size, there is no camera, or a scan as well; or all depths
  //   are beyond 100 m, as millimetres are, by some hundreds of pixels that are looked at;
  // - it has a scan and no stand, and its camera looks up or down, to 10 degrees, as where a
  //   laser's planar pose came without CameraOf();
  // - a scan's max_range_m is negative or not finite, or there is a matched_scan or a stand alone;
  // - the stand is not made of finite numbers, or of a quaternion that is none.
  //
  // What else is amiss is lived with: without a pose nothing is known of the frame, without image
  // or scan only its pose is corrected; beams and pixels that are no distances say nothing
  // (mapper/scan/frame_scans.h); stamps that repeat or go back tell no speed; a loop with a frame
  // that never came or has no pose counts as rejected.
  //
  // Time: mostly 0.1 to 0.3 ms. A few frames adjust or search the map, tens to hundreds of ms and
  // more with many loops, or fill up what is remembered of all frames, which is then moved: 0.1 s
  // each hour or so.
  //
  // Memory: a frame leaves 0.6 kB behind, 60 MB an hour, and its scan where that is kept
  // (KeepOptions), 3 kB and more.
  //
  // The report's pose is of the camera, as the frame's was: of a laser, BaseOf(*map_from_camera).
  FrameReport AddFrame(const Frame& frame);
  // The last correction, then the map drawn from the stored scans at their final poses. It takes
  // seconds after tens of thousands of frames in rooms, and as much longer as scans see more area;
  // frames may come after it, and another end.
  // `slam_final`, one a frame given or empty: SLAM's own final trajectory. It is the final estimate
  // when SLAM is trusted alone (K = 0); frames without one keep their live pose. Throws InputError
  // when it is of another length, or holds a pose that AddFrame() would not take, and when the map
  // would be larger than 2^28 cells, 819 m square at 5 cm; CurrentPoses() tells the way even then.
  MapperResult Finish(const std::vector<std::optional<Pose3>>& slam_final = {});
  // The map as it is known now, drawn anew from all kept scans: 0.1 s for 4,000 of them in rooms,
  // so ask once in a while rather than after each frame. Empty, of no size, while nothing was
  // mapped. Throws InputError, as Finish() does, when the map would be larger than 2^28 cells.
  OccupancyMap CurrentMap() const;
  // What a result's `map_from_camera` and `mapped` would be without the last correction: the way
  // so far, which loops move, and what is to be saved of a map that is not finished.
  std::vector<std::optional<Pose3>> CurrentPoses() const;
  std::vector<MappedFrame> CurrentMapped() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid
