// The movers of a scene made ready: where each is at a time, how near it comes to a point, and what
// a depth camera sees of them. Each is traced in its own axes, so the room's tree never changes.
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
  // Those that are there at a frame of the camera's path. Their clock begins with the first one.
  std::vector<MoverPlace> At(const Trajectory& trajectory, std::size_t frame) const;
  // From a point to the nearest surface of a mover, or `limit_m` when none is nearer; 0 inside it.
  double DistanceM(const MoverPlace& place, const Eigen::Vector3d& point_in_world,
                   double limit_m) const;
  // Whether a mover that goes from one place to the other passes through a camera that moves
  // meanwhile: whether its surface lies between the camera's two points as it has them.
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

// Where a path comes nearer to one of the scene's movers than clearance_m, as NearText says it, or
// where one passes through the camera between two frames; nothing where none does.
std::optional<std::string> NearMoverText(const Trajectory& trajectory, const Scene& scene,
                                         const MoverScene& movers, double clearance_m);

// The names of the movers that no frame shows, up to `most_m` away: whatever stands hides them, or
// the camera looks elsewhere.
std::vector<std::string> UnseenMovers(const Trajectory& trajectory, const Scene& scene,
                                      const RayScene& room, const MoverScene& movers,
                                      const PinholeCamera& camera, double most_m);

// Depth images of movers, laid over those of the room: each pixel keeps the nearer of both.
class MoverCamera {
 public:
  MoverCamera(const MoverScene& movers, const PinholeCamera& camera);

  // Incidence too where the frame has it.
  void DrawOver(const Pose3& world_from_camera, const std::vector<MoverPlace>& places,
                DepthFrame& frame) const;

 private:
  std::vector<DepthCamera> cameras_;  // one a mover
};

}  // namespace depthgrid
