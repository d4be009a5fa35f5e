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

// Frame::index of the first and, unless it lasts until the end, the last frame of a part.
struct GuessedFrames {
  int first = 0;
  std::optional<int> last;
};

// A part over which the map goes another way than SLAM, far more so than elsewhere, and nothing
// that was seen tells which is right: SLAM slipped there, or something that moved along was taken
// for walls and led the map astray.
struct AstrayFrames {
  int first = 0;         // Frame::index of the last frame before it
  int last = 0;          // and of its last one
  double apart_m = 0.0;  // how far the two ways are apart, summed over steps of half a metre
  double usual_m = 0.0;  // of as many steps, by the median
};

struct MapperResult {
  // The final estimate of each frame that AddFrame() accepted, in that order (refused frames have
  // no entry); empty where neither SLAM nor the map gave a pose.
  std::vector<std::optional<Pose3>> map_from_camera;
  // The frames whose scans are kept, at final poses: the map is drawn from these.
  std::vector<MappedFrame> mapped;
  std::vector<PlanarLoop> loops;  // those that the final adjustment accepted
  // What was mapped after a loss of SLAM and neither the search nor a loop placed.
  std::vector<GuessedFrames> guessed;
  std::vector<AstrayFrames> astray;
  OccupancyMap map;
};

// For fusion.mode `oracle`: the gain of a frame per base axis (forward, left, yaw), from an
// experiment that knows the true pose.
using GainOracle = std::function<Eigen::Vector3d(int frame, const Pose2& predicted_map_from_base,
                                                 const Pose2& matched_map_from_base)>;

// The true map_from_base of a frame, for experiments that replace the matched pose by it; the
// match's information matrix is kept.
using MatchOracle = std::function<Pose2(int frame)>;

// A finished map to continue in.
struct PriorMap {
  // In order of time, at final poses, each with both its scans (`scan` and `obstacles`, possibly
  // the same). `frame` is negative and increasing, by one within a drive and by more between
  // drives: later drives count more (GridOptions::earlier_scans). WriteMapped() saves
  // MapperResult::mapped or CurrentMapped(), and ReadMapped() returns it numbered like this
  // (mapper/io/mapped_files.h, docs/examples/second_drive.cc); without a file, PriorNumbers() gives
  // the numbers (mapper/core/drives.h). Number, stamp, pose and scans of a frame suffice.
  std::vector<MappedFrame> frames;
  // Pose of the new SLAM frame in the map, accurate to a few centimetres and degrees; FindStart()
  // in mapper/map_start.h finds it. A larger error is not corrected later. After a restart of the
  // program while SLAM ran on: FrameReport::map_from_slam of the frame at which `frames` was saved.
  Pose2 map_from_slam;
  // Localise only: nothing is inserted, no pose and no cell of the prior map changes.
  bool fixed = false;
};

// Not thread-safe: one thread calls it, or several under one lock, the const functions included.
// What these return are copies, which other threads may read while frames are added. Separate
// mappers share no state. Prints nothing, touches no file, starts no thread.
class IncrementalMapper {
 public:
  // `camera` is that of the depth images, without distortion; not needed when every frame brings a
  // ready scan. Throws InputError for an invalid camera and for options that are out of range or
  // contradict each other.
  IncrementalMapper(const MapperOptions& options, const std::optional<PinholeCamera>& camera,
                    FrameClocks clocks = {}, GainOracle oracle = {});
  ~IncrementalMapper();
  // A moved-from mapper may only be destroyed or assigned to.
  IncrementalMapper(IncrementalMapper&&) noexcept;
  IncrementalMapper& operator=(IncrementalMapper&&) noexcept;

  // Takes effect from the next frame on.
  void SetMatchOracle(MatchOracle oracle);

  // Call once, before the first frame. The result's `mapped` then begins with the prior frames.
  // Throws InputError, and changes nothing, when called later or twice, when a frame's number,
  // pose, stamp or scans break PriorMap's rules, when a beam fails CanBeKept(), or when
  // `map_from_slam` is not finite or beyond 10,000 km; and with method paper, which matches against
  // the last two submaps only, when `submap.scans` is less than the number of prior frames.
  void StartFrom(PriorMap prior);
  // After StartFrom() and before the first frame: another mapper that starts in the same prior map
  // with another map_from_slam, to try several places or to start again later. Takes a fifteenth of
  // StartFrom()'s time, which is half a second for 10,000 frames. Throws InputError without a prior
  // map, after a frame, and for a pose that StartFrom() refuses.
  IncrementalMapper StartedAt(const Pose2& map_from_slam) const;

  // Call once per frame, in order of time. Throws InputError, and leaves the mapper unchanged, when
  // - its number is negative or was used before, or its stamp is not finite;
  // - its pose or a loop is not finite, has a quaternion that is not of unit norm (to 0.001), lies
  //   beyond 10,000 km, or has a sigma that is not positive;
  // - it has an image but the mapper has no camera, or one of another size, or a scan as well; or
  //   all of some hundreds of sampled depths are beyond 100 m and not all the same (probably
  //   millimetres; one number everywhere is taken for no depth);
  // - it has a scan but no stand, and its camera's optical axis is within 10 degrees of vertical,
  //   as when a laser's planar pose is given without CameraOf();
  // - a scan's max_range_m is negative or not finite, or matched_scan or stand is set without a
  //   scan;
  // - the stand is not finite, or its quaternion is not of unit norm.
  //
  // Other faults are tolerated: a frame without a pose gets no estimate; without image or scan its
  // pose is only corrected; beams and pixels with invalid distances are ignored
  // (mapper/scan/frame_scans.h); stamps that repeat or go back give no speed; a loop to a frame
  // that never came or has no pose counts as rejected. A loop at a frame near which nothing of its
  // epoch is mapped, as where a new epoch begins without an image, waits for up to 30 frames until
  // one is; that frame's report counts it.
  //
  // Time: mostly 0.1 to 0.3 ms for a laser's scan, 0.4 to 0.8 ms for a depth image of 640x480.
  // Frames that trigger an adjustment or a search take tens to hundreds of ms, more with many
  // loops. About once an hour a vector over all frames is reallocated (0.1 s).
  //
  // Memory: a frame leaves 0.6 kB behind, 60 MB an hour, and its scan where that is kept
  // (KeepOptions), 3 kB and more.
  //
  // The report's pose is the camera's, as the frame's is; for a laser use BaseOf(*map_from_camera).
  FrameReport AddFrame(const Frame& frame);
  // Does the final adjustment, then draws the map from the stored scans at their final poses. Takes
  // seconds for tens of thousands of frames in rooms, more where scans cover more area. More
  // frames, and another Finish(), may follow. `slam_final`: SLAM's own final trajectory, one entry
  // per accepted frame, or empty. It is the final estimate when only SLAM is trusted (K = 0);
  // frames without an entry keep their live pose. Throws InputError when its length is wrong or
  // AddFrame() would refuse one of its poses, and when the map would be larger than 2^28 cells, 819
  // m square at 5 cm; CurrentPoses() works even then.
  MapperResult Finish(const std::vector<std::optional<Pose3>>& slam_final = {});
  // The current map, redrawn from all kept scans: 0.1 s for 4,000 of them in rooms, so do not call
  // it for every frame; a MapDrawing can be drawn on, in another thread
  // (docs/examples/live_mapper.cc). Of size zero while nothing was mapped. Throws InputError, as
  // Finish() does, when the map would be larger than 2^28 cells.
  OccupancyMap CurrentMap() const;
  // `map_from_camera` and `mapped` as of now, without the final adjustment; later loops still move
  // them. For showing the trajectory so far, and for drawing or saving an unfinished map: the copy
  // of 4,000 mapped frames takes 1 to 5 ms, its scans are shared and never change.
  std::vector<std::optional<Pose3>> CurrentPoses() const;
  std::vector<MappedFrame> CurrentMapped() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid
