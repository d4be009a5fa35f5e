// A frame of a map with its scans: maps are drawn from these, saved as these and continued from
// these.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/frame_report.h"
#include "mapper/core/kept_scan.h"
#include "mapper/core/pose2.h"

namespace depthgrid {

// MappedFrame::gap_share where the place was guessed, and after a gap of 3 s or more.
constexpr double kGuessedShare = 10.0;

// A frame that was inserted, in order of time.
struct MappedFrame {
  int frame = 0;  // Frame::index; negative: of a prior map
  double stamp_s = 0.0;
  // -1: this frame's scans are kept. Otherwise its place is well seen already, and this is the
  // index, in the vector of MappedFrame, of the kept frame it moves with; its own scans are dropped
  // soon.
  int tied_to = -1;
  KeptScan scan;       // what is matched
  KeptScan obstacles;  // what the map is drawn from; often the same
  Pose2 map_from_base;
  // SLAM's motion from the previous mapped frame; empty for the first and across epochs. In a prior
  // map, the motion between the final poses.
  std::optional<Pose2> slam_motion;
  // Where it is empty: how well the motion from the previous mapped frame was known without SLAM,
  // as a multiple of kEpochSigma, at most kGuessedShare.
  double gap_share = 1.0;
  // SLAM's pose did not move since the previous frame (Standing).
  bool stands = false;
  // Its scan told a wrong pose, as something moved along: at the end its pose is SLAM's motion from
  // the frame before.
  bool led_astray = false;
  MatchResult match;  // its information in axes of the matched pose

  bool kept() const { return tied_to < 0; }
  bool of_prior_map() const { return frame < 0; }
};

// Sets a corrected pose. The match of a tied frame moves with it: an adjustment uses it as it lies
// to the frame's pose.
inline void MoveFrame(const Pose2& map_from_base, MappedFrame& frame) {
  if (!frame.kept()) {
    frame.match.map_from_base =
        map_from_base * Between(frame.map_from_base, frame.match.map_from_base);
  }
  frame.map_from_base = map_from_base;
}

// Frames with corrected poses, one for each.
inline std::vector<MappedFrame> WithPoses(std::vector<MappedFrame> frames,
                                          const std::vector<Pose2>& map_from_base) {
  for (std::size_t i = 0; i < frames.size(); ++i) MoveFrame(map_from_base[i], frames[i]);
  return frames;
}

inline std::vector<Pose2> PosesOf(const std::vector<MappedFrame>& frames) {
  std::vector<Pose2> map_from_base;
  for (const MappedFrame& frame : frames) map_from_base.push_back(frame.map_from_base);
  return map_from_base;
}

inline const MappedFrame& FrameAt(const std::vector<MappedFrame>& frames, int i) {
  return frames[static_cast<std::size_t>(i)];
}

}  // namespace depthgrid
