// What the mapper remembers of its input frames, and how it finds their poses again after the map
// was corrected.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mapper/core/frame.h"
#include "mapper/core/reference_map.h"
#include "mapper/core/slam_epochs.h"
#include "mapper/core/usual_step.h"
#include "mapper/scan/stand_blend.h"

namespace depthgrid {

struct FrameRecord {
  int index = 0;  // Frame::index
  double stamp_s = 0.0;
  std::optional<Pose3> slam_from_camera;
  int epoch = 0;        // as SlamEpochs counts
  int mapped = -1;      // position among the mapped frames, -1 if not inserted
  Pose2 map_from_slam;  // the correction as it was known at the time
  // Over the floor that is followed in the images; empty where it is not, and the pose's counts.
  std::optional<CameraStand> stand;
};

class FrameHistory {
 public:
  // Starts the record of a frame. Throws InputError for an index that came before.
  void Start(const Frame& frame);
  // The newest frame's pose is not reached from the one before by the motion between them.
  void BeginEpoch() { records_.back().epoch = epochs_.BeginAtLast(); }

  const std::vector<FrameRecord>& records() const { return records_; }
  const FrameRecord& newest() const { return records_.back(); }
  FrameRecord& newest() { return records_.back(); }
  // Null for an index that was never given.
  const FrameRecord* Find(int frame_index) const;
  // The last frame before one that has a pose; null if there is none.
  const FrameRecord* PosedBefore(const FrameRecord& record) const;
  // Whether SLAM comes back with the newest frame: to poses of another epoch, or after frames
  // without any. A recording that paused lost nothing.
  bool WasLost() const;
  // Whether SLAM's newest pose lies far beyond where its usual motion leads in the frames since the
  // last one.
  bool OutranUsualMotion() const;
  // From the record before to the newest, in usual steps of time: more than one where the recording
  // paused and SLAM moved on meanwhile (MovingStepsIn); one where SLAM was lost or began another
  // epoch.
  int FramesToNewest() const;
  // The mapped frame closest in order to a frame, itself if it is mapped, of the same epoch and at
  // most `reach` input frames away; null if there is none.
  const FrameRecord* NearestMapped(const FrameRecord& record, int reach) const;

 private:
  std::vector<FrameRecord> records_;
  // Frame::index and position in records_, ordered by index, which mostly is the order they come
  // in.
  using Positions = std::vector<std::pair<int, std::size_t>>;
  // The first entry that is not before this index.
  Positions::const_iterator PlaceOf(int frame_index) const;
  UsualMotion UsualMotionSoFar() const;

  Positions position_of_index_;
  SlamEpochs epochs_;
};

// Where the newest frame is if the last motion goes on; `map_from_slam` is the correction of the
// frame before it.
struct Extrapolation {
  Pose2 map_from_base;
  bool near = false;         // the last pose was so short ago that this is near it
  bool next = false;         // and that no camera goes elsewhere
  double sigma_share = 1.0;  // of kEpochSigma, how well it is known
};
Extrapolation Extrapolated(const FrameHistory& history, const Pose2& map_from_slam);

// A loop between two frames as one between two mapped frames, by SLAM's own motion within an epoch.
// Empty if a frame is unknown, has no pose or nothing near it is mapped. `newest_mapped` is the
// position the newest frame will have, or -1.
std::optional<PlanarLoop> ProjectLoop(const LoopClosure& loop, const FrameHistory& history,
                                      int newest_mapped);

// A frame's camera in the map: SLAM's pose corrected in the plane, its height and tilt blended
// with those over the floor where that is followed.
Pose3 CameraPose(const FrameRecord& record, const Pose2& map_from_slam, const StandBlend& stands);

// Each frame's camera pose in the map, given those of the mapped frames: a frame that was not
// mapped takes the correction of the nearest mapped one of its epoch, else the one it had online.
std::vector<std::optional<Pose3>> FinalPoses(const FrameHistory& history,
                                             const std::vector<Pose2>& map_from_base_of_mapped,
                                             const StandBlend& stands);

}  // namespace depthgrid
