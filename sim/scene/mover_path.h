// Where a mover is at a time: along smooth curves from stop to stop, each timed like a camera path.
#pragma once

#include <optional>
#include <vector>

#include "mapper/core/pose2.h"
#include "sim/path/camera_path.h"
#include "sim/scene/mover.h"

namespace depthgrid {

class MoverPath {
 public:
  // Throws InputError for waypoints no path goes through.
  explicit MoverPath(const MoverOptions& options);

  // world_from_mover, `time_s` after the first frame; nothing while it is not there. Its x axis is
  // where it goes. `world_from_base` is the camera's.
  std::optional<Pose2> At(double time_s, const Pose2& world_from_base) const;

  // Once along its waypoints, or round, or there and back; 0 for one ahead of the camera.
  double RoundS() const { return round_s_; }

 private:
  // From one stop to the next, where it turns towards the next walk's beginning and waits.
  struct Walk {
    CameraPath path;
    Pose2 end;
    double turn_rad = 0.0;
    double turn_s = 0.0;
    double stand_s = 0.0;  // the turn, at its end, included
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
