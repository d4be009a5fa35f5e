// The curve of a camera path and its timing under speed and turn-rate bounds; sampled by
// sim/path/trajectory.h.
#pragma once

#include <optional>

#include "sim/path/cubic_spline.h"
#include "sim/path/trajectory.h"

namespace depthgrid {

// A camera pose without hand shake; roll is 0.
struct PathPose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;    // unwrapped: continuous along the path
  double pitch_rad = 0.0;  // up is positive
};

class CameraPath {
 public:
  // Throws InputError for waypoints without a valid path (too few, equal neighbours, looking
  // straight up or down).
  explicit CameraPath(const TrajectoryOptions& options);

  // The shortest duration that keeps speed and turn rate within their bounds.
  double DurationS() const { return duration_s_; }
  // The pose at a fraction, 0 to 1, of the path's duration.
  PathPose At(double share) const;

 private:
  PathPose PoseAt(double u) const;
  void BuildCurve(const TrajectoryOptions& options);
  void BuildTiming(const TrajectoryOptions& options);
  // The least time per unit of the curve parameter u that the bounds allow.
  double SecondsPerUnit(double u, const TrajectoryOptions& options) const;

  bool planar_ = false;
  double pitch_rad_ = 0.0;
  double first_u_ = 0.0;
  double last_u_ = 0.0;
  double duration_s_ = 0.0;
  std::optional<CubicSpline> curve_;      // x y z yaw pitch, or x y z, over u
  std::optional<CubicSpline> parameter_;  // u over time
};

// The camera pose whose optical axis has this yaw and pitch, with roll 0.
Pose3 CameraPoseOf(const PathPose& pose);

}  // namespace depthgrid
