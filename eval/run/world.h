// The true world of an experiment: room, camera and camera path.
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

// Hashes of the contents; they change when any of the files does.
struct WorldHashes {
  std::string room;        // of the triangles of the static scene
  std::string scene;       // and of the movers in it: all that the depth camera can see
  std::string trajectory;  // of the whole path in the scene or its file, even if the experiment
                           // uses only part of it
};

struct World {
  Scene scene;  // only with the movers that the experiment names
  WorldHashes hashes;
  RayScene rays;  // of the static scene
  MoverScene movers;
  PinholeCamera camera;
  DepthRange depth_range;
  Trajectory trajectory;
  // Warnings about a path from a file, with its name (a scene's own path is rejected instead), and
  // about movers that are never seen.
  std::vector<std::string> path_doubts;
};

// Hashes of the room and the path that an experiment names. Throw InputError when they cannot be
// read.
WorldHashes HashesOf(const ExperimentOptions& options);
std::string HashOfPathFile(const ExperimentOptions& options);  // only of a path from a file
std::string WorldHash(const ExperimentOptions& options);       // of both together

// Checks that the scene can be read and has the named movers and path, or that the path's file can
// be read. Throws InputError. Faster than LoadWorld, which checks more.
void RequireNames(const ExperimentOptions& options);

// The same of the scene and the movers alone, whatever the path.
void RequireMovers(const ExperimentOptions& options);

// Where the path is defined, for error messages: its file, or its line in the scene's file.
std::string PlaceOfPath(const Scene& scene, const ExperimentOptions& options);

// Checks that a path made from the scene's options is within the scene and keeps its clearance.
// Throws InputError.
void CheckPath(const Trajectory& trajectory, const TrajectoryOptions& path, const Scene& scene,
               const RayScene& rays);

// Checks that no mover of the scene comes nearer to the path than its clearance. Throws InputError.
void CheckMovers(const Trajectory& trajectory, const TrajectoryOptions& path, const Scene& scene,
                 const MoverScene& movers);

// Loads and checks all of it. `build_threads` affects only the speed. Throws InputError, also for a
// scene's path too near to geometry, and for a path from a file too far from the scene.
World LoadWorld(const ExperimentOptions& options, int build_threads);

}  // namespace depthgrid
