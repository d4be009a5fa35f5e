// The movers of a scene prepared for queries: their poses over time, their distance to a point and
// their depth images. Each has its own ray tree in its own axes, so the room's tree never changes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapper/core/trajectory.h"
#include "sim/depth/depth_camera.h"
#include "sim/depth/ray_scene.h"
#include "sim/scene/mover_path.h"
#include "sim/scene/scene.h"

namespace depthgrid {

struct MoverPlace {
  std::size_t mover = 0;  // index into Scene::movers
  Pose3 world_from_mover;
};

class MoverScene {
 public:
  MoverScene(const Scene& scene, RayIsa isa);

  std::size_t size() const { return movers_.size(); }
  // The movers present at a frame of the camera's path; their time starts at the first frame.
  std::vector<MoverPlace> At(const Trajectory& trajectory, std::size_t frame) const;
  // Distance from a point to a mover's nearest surface, at most `limit_m`; 0 inside the mover.
  double DistanceM(const MoverPlace& place, const Eigen::Vector3d& point_in_world,
                   double limit_m) const;
  // Whether a mover passes through the camera while both move: whether its surface lies between the
  // camera's two positions, each taken in the mover's axes at that time.
  bool Passes(const MoverPlace& before, const Eigen::Vector3d& camera_before, const MoverPlace& now,
              const Eigen::Vector3d& camera_now) const;
  const RayScene& RaysOf(std::size_t mover) const { return movers_[mover].rays; }

 private:
  struct Ready {
    MoverPath path;
    TriangleMesh mesh;
    Eigen::AlignedBox3f bounds;
    RayScene rays;
  };
  std::vector<Ready> movers_;
  double floor_z_m_;
};

// Describes where a path comes nearer than clearance_m to a mover (see NearText), or where a mover
// passes through the camera between two frames; nothing if neither happens.
std::optional<std::string> NearMoverText(const Trajectory& trajectory, const Scene& scene,
                                         const MoverScene& movers, double clearance_m);

// The names of the movers that are not visible in any frame within `most_m`: hidden by the room or
// outside the image.
std::vector<std::string> UnseenMovers(const Trajectory& trajectory, const Scene& scene,
                                      const RayScene& room, const MoverScene& movers,
                                      const PinholeCamera& camera, double most_m);

// Draws movers into depth images of the room: each pixel keeps the nearer depth.
class MoverCamera {
 public:
  MoverCamera(const MoverScene& movers, const PinholeCamera& camera);

  // Also updates the incidence if the frame has it.
  void DrawOver(const Pose3& world_from_camera, const std::vector<MoverPlace>& places,
                DepthFrame& frame) const;

 private:
  std::vector<DepthCamera> cameras_;  // one per mover
};

}  // namespace depthgrid
