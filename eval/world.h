// The true side of an experiment: the room, the camera and where the camera went.
#pragma once

#include <string>
#include <vector>

#include "eval/experiment_options.h"
#include "mapper/core/camera.h"
#include "mapper/core/trajectory.h"
#include "sim/ray_scene.h"
#include "sim/scene.h"

namespace depthgrid {

struct World {
  Scene scene;
  std::string scene_hash;  // of triangles, floor and ceiling: what the depth camera can see
  RayScene rays;
  PinholeCamera camera;
  DepthRange depth_range;
  Trajectory trajectory;
  // What is amiss with a path that was read from a file, which each names; those of scenes are
  // refused.
  std::vector<std::string> path_doubts;
};

// Of the room and the path that an experiment names: another one when any of the files was changed.
// Throws InputError when they cannot be read.
std::string WorldHash(const ExperimentOptions& options);

// Loads and checks all of it. `build_threads` only changes the speed. Throws InputError, also for a
// path that comes too near to geometry, and for one of a file that leads out of all reach.
World LoadWorld(const ExperimentOptions& options, int build_threads);

}  // namespace depthgrid
