// Depth images and level scans of rooms with a closed form: an upright box seen from inside,
// furniture boxes and vertical cylinders in it.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/level.h"
#include "mapper/core/pose3.h"

namespace depthgrid {

// Above the floor, of the camera in ICL-NUIM's living room.
inline constexpr double kCameraHeightM = 1.15;

struct AnalyticRoom {
  struct Box {
    Eigen::Vector3d low, high;
  };
  struct Cylinder {
    Eigen::Vector2d centre;
    double radius_m;
    double low_m, high_m;
  };
  Box walls{{-3.0, -2.5, 0.0}, {3.0, 2.5, 2.5}};
  std::vector<Box> boxes;
  std::vector<Cylinder> cylinders;

  // Distance along the ray origin + t direction to the first surface, and the incidence angle
  // there.
  struct Hit {
    double t = std::numeric_limits<double>::infinity();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  Hit Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    Hit hit;
    const auto offer = [&](double t, const Eigen::Vector3d& normal) {
      if (t > 1e-9 && t < hit.t) hit = {t, normal};
    };
    const auto box_planes = [&](const Box& box, bool inside) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double plane : {box.low[axis], box.high[axis]}) {
          const double t = (plane - origin[axis]) / direction[axis];
          const Eigen::Vector3d point = origin + t * direction;
          bool on_face = std::isfinite(t);
          for (int other = 0; other < 3; ++other) {
            if (other != axis) {
              on_face = on_face && point[other] >= box.low[other] - (inside ? 1e-9 : 0.0) &&
                        point[other] <= box.high[other] + (inside ? 1e-9 : 0.0);
            }
          }
          if (on_face) offer(t, Eigen::Vector3d::Unit(axis));
        }
      }
    };
    box_planes(walls, true);
    for (const Box& box : boxes) box_planes(box, false);
    for (const Cylinder& cylinder : cylinders) {
      const Eigen::Vector2d d = direction.head<2>();
      const Eigen::Vector2d o = origin.head<2>() - cylinder.centre;
      const double a = d.squaredNorm();
      const double b = o.dot(d);
      const double root = b * b - a * (o.squaredNorm() - cylinder.radius_m * cylinder.radius_m);
      if (root < 0.0) continue;
      const double t = (-b - std::sqrt(root)) / a;
      const Eigen::Vector3d point = origin + t * direction;
      if (point.z() < cylinder.low_m || point.z() > cylinder.high_m) continue;
      const Eigen::Vector2d outwards = (o + t * d).normalized();
      offer(t, {outwards.x(), outwards.y(), 0.0});
    }
    return hit;
  }

  DepthImage Render(const PinholeCamera& camera, const Pose3& world_from_camera) const {
    DepthImage image(camera.width_px, camera.height_px);
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        // A ray with z = 1 in the camera: its parameter is the depth.
        const Eigen::Vector3d direction = world_from_camera.rotation * Unproject(camera, u, v, 1.0);
        image.Row(v)[u] = static_cast<float>(Cast(world_from_camera.translation, direction).t);
      }
    }
    return image;
  }

  struct LevelReturn {
    double range_m = 0.0;
    double incidence_rad = 0.0;
  };
  // What a level laser at `height_m` would measure at a bearing from base.
  LevelReturn Level(const Pose2& world_from_base, double bearing_rad, double height_m) const {
    const double angle_rad = world_from_base.yaw_rad + bearing_rad;
    const Eigen::Vector3d direction(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    const Hit hit = Cast({world_from_base.x_m, world_from_base.y_m, height_m}, direction);
    return {hit.t, std::acos(std::min(1.0, std::abs(hit.normal.dot(direction))))};
  }
};

inline AnalyticRoom RoomWithWallAt(double x_m) {
  AnalyticRoom room;
  room.walls = {{-3.0, -6.0, 0.0}, {x_m, 6.0, 2.5}};
  return room;
}

// A camera at the base pose, pitched (positive looks down) and rolled about its optical axis.
inline Pose3 TiltedCamera(const Pose2& world_from_base, double height_m, double pitch_down_rad,
                          double roll_rad) {
  Pose3 pose = CameraOf(world_from_base, height_m);
  pose.rotation = (pose.rotation * Eigen::AngleAxisd(-pitch_down_rad, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()))
                      .normalized();
  return pose;
}

}  // namespace depthgrid
