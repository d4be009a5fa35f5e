// The mapper's online result for one frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// The pose of a frame before matching, SLAM's pose in the map, with its covariance.
struct Prediction {
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // base axes: forward m, left m, yaw rad
  // Of SLAM's motion from the frame before alone; empty where that is not learnt, after a pause and
  // where the pose was placed anew.
  std::optional<Eigen::Matrix3d> motion_covariance = {};
};

// Scales of small motions (forward m, left m, yaw rad): 1/3 rad moves points 3 m away by 1 m.
inline const Eigen::Vector3d kMotionUnit(1.0, 1.0, 1.0 / 3.0);

// A scan matched against what was mapped before. Not finding a match is an ordinary outcome.
struct MatchResult {
  bool found = false;
  Pose2 map_from_base;  // meaningful only when found
  // Inverse covariance of map_from_base for a small motion (forward m, left m, yaw rad) in base
  // axes of the matched pose (in a FrameReport: of the predicted pose); zero along directions the
  // scan does not constrain (a corridor's axis).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double score = 0.0;  // share of the beams that the map explains, 0..1
  int explained = 0;   // as a number of surface pieces; 0 where not counted
  int iterations = 0;
  // Pieces of something that moves were left out one by one (SurfelMatcher). Some of it may have
  // stayed in, so such a match errs by more than it claims, and SLAM's noise is not learnt from it.
  bool left_out_misfits = false;
};

// CPU time of a frame, divided among its stages in proportion to their wall time; microseconds.
// Only written to the timing files.
struct StageTimes {
  double scan_us = 0.0;
  double match_us = 0.0;
  double fuse_us = 0.0;
  double insert_us = 0.0;
  double loops_us = 0.0;
  double total_us = 0.0;
};

struct FrameReport {
  int index = 0;
  double stamp_s = 0.0;
  // The input; empty where it repeats a pose while the sensor moves, and moved on where it does so
  // as odometry is slower than the scans (Frame::slam_from_camera).
  std::optional<Pose3> slam_from_camera;
  int slam_epoch = 0;
  std::optional<Pose3> map_from_camera;  // the online estimate; empty while unknown
  // The correction after this frame, in the map as it is then: of the next pose of the same epoch.
  Pose2 map_from_slam;
  MatchResult match;
  std::array<double, 3> innovation = {};  // match against prediction in base axes: m, m, rad
  // Chi-square of the innovation, its covariance including the errors of the matched map; where the
  // gate refused the match, with the gate's covariance (prediction and match only).
  double innovation_chi2 = 0.0;
  std::array<double, 3> gain = {};  // the diagonal of K, base axes
  // Covariance of the estimate in base axes, taking the map as exact.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // Covariance of the estimated motion from frame `motion_from` (a FrameReport::index, at most
  // submap.scans back and not before a correction of the map) to this one, including the errors of
  // the matched map, in base axes of this frame. -1 and zero if not tracked.
  int motion_from = -1;
  Eigen::Matrix3d motion_covariance = Eigen::Matrix3d::Zero();
  bool innovation_rejected = false;  // the gate refused the match
  int beams = 0;                     // beams with a hit in the matched scan
  int loops_accepted = 0;            // loop events that entered the graph with this frame
  int loops_rejected = 0;
  bool slipped = false;  // SLAM's motion to here contradicted the scan and was corrected
  // The scan contradicts the map so that the camera must have been carried elsewhere, as no pose
  // tells: from this frame on the place is searched for as after a loss of SLAM.
  bool carried = false;
  // The frames since a loss of SLAM were moved to where they belong; not where the guess was right.
  bool relocated = false;
  // After a loss of SLAM: the pose relative to the map from before it is only a guess, until the
  // wide search finds the place or an accepted loop joins the two parts.
  bool guessed = false;
  // What was mapped before this frame has changed: its poses were adjusted (a round of adjustment,
  // a loop, a slide, a relocation, the first frames mapped again), or an object that moves was
  // taken out. Maps drawn before are out of date, poses in them too; map_from_camera of this frame
  // may still be from before, map_from_slam is not. While it is false a map only grows
  // (MapDrawing).
  bool map_corrected = false;
  // Of all earlier mapped frames, those of a prior map included: how far any was moved and how far
  // any was turned, at most. 0 where nothing moved; what is seen 3 m away moves 3 m a radian more.
  double map_moved_m = 0.0;
  double map_turned_rad = 0.0;
  bool inserted = false;             // its scan is kept for the map
  bool well_seen = false;            // its place has enough scans: the frame is tied to a kept one
  std::optional<CameraStand> stand;  // of a depth image: tilt and height its scan was made with
  StageTimes times;
};

// The share of a frame's scan that the map explains.
inline double ShareExplained(const FrameReport& report) {
  return report.match.found ? report.match.score : 0.0;
}

}  // namespace depthgrid
