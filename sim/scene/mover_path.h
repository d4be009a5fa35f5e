// A mover's pose over time: smooth curves from stop to stop, each timed like a camera path.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/pose2.h"
#include "sim/path/camera_path.h"
#include "sim/scene/mover.h"

namespace depthgrid {

class MoverPath {
 public:
  // Throws InputError for waypoints without a valid path.
  explicit MoverPath(const MoverOptions& options);

  // world_from_mover at `time_s` after the first frame, x axis in the direction of motion; nothing
  // while it is absent. `world_from_base` is the camera's pose.
  std::optional<Pose2> At(double time_s, const Pose2& world_from_base) const;

  // Duration of one pass along the waypoints (one round, or there and back); 0 for one that keeps
  // ahead of the camera.
  double RoundS() const { return round_s_; }

 private:
  // The walk to the next stop, where it turns towards the next walk's start and waits.
  struct Walk {
    CameraPath path;
    Pose2 end;
    double turn_rad = 0.0;
    double turn_s = 0.0;
    double stand_s = 0.0;  // time at the stop; ends with the turn
  };
  void AddWalk(const std::vector<std::size_t>& stations);
  void AddStands(const std::vector<double>& waits_s);
  Pose2 InRound(double since_s) const;
  static Pose2 PoseIn(const Walk& walk, double since_s);

  MoverOptions options_;
  bool repeats_ = false;
  std::vector<Walk> walks_;
  double round_s_ = 0.0;
};

}  // namespace depthgrid
