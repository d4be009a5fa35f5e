// What the mapper says of one frame, as it was known at the time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "mapper/core/camera_stand.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// Where a frame is before matching: SLAM's pose carried into the map, and how sure that is.
struct Prediction {
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // base axes: forward m, left m, yaw rad
};

// Units of small motions (forward m, left m, yaw rad) in which a metre and a radian weigh alike to
// a view 3 m deep.
inline const Eigen::Vector3d kMotionUnit(1.0, 1.0, 1.0 / 3.0);

// A scan matched against what was mapped before. Not finding a match is an ordinary outcome.
struct MatchResult {
  bool found = false;
  Pose2 map_from_base;  // meaningful only when found
  // Inverse covariance of map_from_base for a small motion (forward m, left m, yaw rad) in base
  // axes (a mapper's report: those of the predicted pose); zero along directions the scan does not
  // see (a corridor's axis).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double score = 0.0;  // share of the beams that the map explains, 0..1
  int explained = 0;   // how many pieces of surface these are; 0 where that is not counted
  int iterations = 0;
};

// CPU time of a frame, and what its stages took of it (by the time that passed), microseconds.
// Never part of the result, only of the timing files.
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
  std::optional<Pose3> slam_from_camera;  // the input
  int slam_epoch = 0;
  std::optional<Pose3> map_from_camera;  // the online estimate; empty while nothing is known
  Pose2 map_from_slam;                   // the correction after this frame
  MatchResult match;
  std::array<double, 3> innovation = {};  // match against prediction in base axes: m, m, rad
  // Against its covariance, the errors of the map that was matched against included; of what the
  // gate refused, against prediction and match as the gate has it.
  double innovation_chi2 = 0.0;
  std::array<double, 3> gain = {};  // the diagonal of K, base axes
  // Of the estimate in base axes, the map taken for exact.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // The motion of the estimate from an earlier frame (FrameReport::index; at most a submap's frames
  // back, and none before a correction of the map) and its covariance, the errors of the map that
  // it was matched against included: base axes of this frame; -1 and zero if not tracked.
  int motion_from = -1;
  Eigen::Matrix3d motion_covariance = Eigen::Matrix3d::Zero();
  bool innovation_rejected = false;  // the gate refused the match
  int beams = 0;                     // beams with a hit, of what is matched
  int loops_accepted = 0;            // loop events of this frame that entered the graph
  int loops_rejected = 0;
  bool slipped = false;    // SLAM's motion to here did not fit what is seen: it was put right
  bool relocated = false;  // what was mapped since a loss of SLAM was moved to where it belongs
  // Since a loss of SLAM: where the frame lies to what was mapped before is a guess. It ends where
  // the place is found, and where a loop is accepted that joins both.
  bool guessed = false;
  bool inserted = false;             // its scan is kept for the map
  bool well_seen = false;            // its place was seen enough: the frame moves with another's
  std::optional<CameraStand> stand;  // of a depth image: what its scan was made with
  StageTimes times;
};

}  // namespace depthgrid
