// The true side of an experiment: the room, the camera and where the camera went.
#pragma once

#include <string>
#include <vector>

#include "eval/experiment/experiment_options.h"
#include "mapper/core/camera.h"
#include "mapper/core/trajectory.h"
#include "sim/depth/ray_scene.h"
#include "sim/scene/mover_scene.h"
#include "sim/scene/scene.h"

namespace depthgrid {

// Others when any of the files was changed.
struct WorldHashes {
  std::string room;        // of triangles: what stands
  std::string scene;       // and of the movers that are there: what the depth camera can see
  std::string trajectory;  // of the path as the scene or its file gives it, whatever is cut off it
};

struct World {
  Scene scene;  // with those movers alone that the experiment names
  WorldHashes hashes;
  RayScene rays;  // of what stands
  MoverScene movers;
  PinholeCamera camera;
  DepthRange depth_range;
  Trajectory trajectory;
  // What is amiss with a path that was read from a file, which each names (those of scenes are
  // refused), and movers that it never sees.
  std::vector<std::string> path_doubts;
};

// Of the room and the path that an experiment names. Throw InputError when they cannot be read.
WorldHashes HashesOf(const ExperimentOptions& options);
std::string HashOfPathFile(const ExperimentOptions& options);  // of a path from a file, alone
std::string WorldHash(const ExperimentOptions& options);       // both as one

// That the scene can be read and has the movers and the path that are named, or the path's file can
// be read. Throws InputError; quicker than LoadWorld, which asks more of them.
void RequireNames(const ExperimentOptions& options);

// Where the path is written: its file, or the scene's line that names it.
std::string PlaceOfPath(const Scene& scene, const ExperimentOptions& options);

// That this path, which the scene's options gave, lies within the scene and keeps its clearance.
// Throws InputError.
void CheckPath(const Trajectory& trajectory, const TrajectoryOptions& path, const Scene& scene,
               const RayScene& rays);

// That none of the scene's movers comes nearer to it than its clearance. Throws InputError.
void CheckMovers(const Trajectory& trajectory, const TrajectoryOptions& path, const Scene& scene,
                 const MoverScene& movers);

// Loads and checks all of it. `build_threads` only changes the speed. Throws InputError, also for a
// path that comes too near to geometry, and for one of a file that leads out of all reach.
World LoadWorld(const ExperimentOptions& options, int build_threads);

}  // namespace depthgrid
