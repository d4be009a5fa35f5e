// Records of the input frames, from which their poses are recomputed after corrections of the map.
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
  int epoch = 0;        // as counted by SlamEpochs
  int mapped = -1;      // index among the mapped frames, -1 if not mapped
  Pose2 map_from_slam;  // the correction at that time
  // Tilt and height over the floor tracked in the images; empty without tracking: the pose's are
  // used.
  std::optional<CameraStand> stand;
};

class FrameHistory {
 public:
  // Starts the record of a frame; not `is_told`: its pose is the last one moved on, which begins no
  // epoch. Throws InputError for an index that came before.
  void Start(const Frame& frame, bool is_told = true);
  // Makes the newest frame begin an epoch: its pose minus the previous one is no motion.
  void BeginEpoch() { records_.back().epoch = epochs_.BeginAtLast(); }

  // Moves the corrections of this frame and of all since, and makes them frames not mapped.
  void Unmap(int first_frame_index, const Pose2& motion);

  const std::vector<FrameRecord>& records() const { return records_; }
  const FrameRecord& newest() const { return records_.back(); }
  FrameRecord& newest() { return records_.back(); }
  // Null for an index that was never given.
  const FrameRecord* Find(int frame_index) const;
  // The last frame with a pose before `record`; null if there is none.
  const FrameRecord* PosedBefore(const FrameRecord& record) const;
  // Whether SLAM returns with the newest frame after frames without pose or in a new epoch. A pause
  // of the recording is no loss.
  bool WasLost() const;
  // Whether it returns in a new epoch after frames without pose.
  bool RestartedAfterLoss() const;
  // Whether the newest frame comes after a pause of the recording: half a second and five usual
  // steps. SLAM may have gone elsewhere meanwhile.
  bool HadPause() const;
  // Whether SLAM's newest motion is far larger than usual for the number of frames since the last
  // pose.
  bool OutranUsualMotion() const;
  // The longest way since an earlier frame that is not far longer than usual.
  double LongestUsualWayM(const FrameRecord& since) const;
  // Frames that the newest motion counts as: more than one after a pause in which SLAM moved
  // (MovingStepsIn); 1 after a loss or in a new epoch.
  int FramesToNewest() const;
  // The usual step before the newest frame, s; 0 while there was none.
  double UsualStepBeforeNewest() const;
  // The mapped frame of the same epoch nearest in input order (possibly itself), at most `reach`
  // frames away; null if there is none.
  const FrameRecord* NearestMapped(const FrameRecord& record, int reach) const;

 private:
  std::vector<FrameRecord> records_;
  // Frame::index and position in records_, sorted by index, mostly also the order of arrival.
  using Positions = std::vector<std::pair<int, std::size_t>>;
  // The first entry whose index is not less.
  Positions::const_iterator PlaceOf(int frame_index) const;
  UsualMotion UsualMotionSoFar() const;
  int StepsToNewest() const;

  Positions position_of_index_;
  SlamEpochs epochs_;
};

// The newest frame's pose if the last motion continues; `map_from_slam` is the previous frame's
// correction.
struct Extrapolation {
  Pose2 map_from_base;
  bool near = false;         // the last pose is recent enough for this to be near the truth
  bool next = false;         // the last pose is one frame ago (0.1 s at most)
  double sigma_share = 1.0;  // uncertainty as a multiple of kEpochSigma
  // How well the motion is known, the same: 1 but where that of one frame went on.
  double gap_share = 1.0;
};
// Longest gap over which the last motion is extrapolated, if nothing tells more.
constexpr double kNearS = 0.5;
Extrapolation Extrapolated(const FrameHistory& history, const Pose2& map_from_slam,
                           double near_s = kNearS);

// MappedFrame::gap_share of the frame after a gap of so many seconds in SLAM's motion.
double ShareOfGap(double gap_s);

// Converts a loop between two frames to one between mapped frames, using SLAM's motion within an
// epoch. Empty if a frame is unknown, has no pose or nothing near it is mapped. `newest_mapped`:
// index that the newest frame will have, or -1.
std::optional<PlanarLoop> ProjectLoop(const LoopClosure& loop, const FrameHistory& history,
                                      int newest_mapped);

// Of a loop that ProjectLoop() does not convert now: whether it may once a later frame is mapped,
// as where SLAM begins an epoch at a frame without an image. For at most 30 frames.
bool MayBeProjectedLater(const LoopClosure& loop, const FrameHistory& history);

// A frame's camera pose in the map: SLAM's pose with the planar correction, height and tilt blended
// with those over the tracked floor, if any.
Pose3 CameraPose(const FrameRecord& record, const Pose2& map_from_slam, const StandBlend& stands);

// Each frame's camera pose in the map, given those of the mapped frames: a frame that was not
// mapped uses the correction of the nearest mapped one of its epoch, else its online correction.
std::vector<std::optional<Pose3>> FinalPoses(const FrameHistory& history,
                                             const std::vector<Pose2>& map_from_base_of_mapped,
                                             const StandBlend& stands);

}  // namespace depthgrid
