// Which way is up in a recording whose world is not level: the floor's plane in some of its depth
// images, seen through their poses (docs/formats.md, "World conventions").
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"
#include "mapper/io/surface_view.h"

namespace depthgrid {

struct Gravity {
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();
  // By how much up differs from image to image: SLAM's tilt wanders and normals have errors. Nine
  // of ten images are nearer.
  double wander_rad = 0.0;
  // More than normals' errors explain: SLAM's tilt drifts, and up is as the first images have it.
  bool drifts = false;
  // Of the floor along `up`: up . point. Where SLAM's height drifts so much that the images do not
  // agree on one floor, as the first images have it.
  double floor_m = 0.0;
  double camera_height_m = 0.0;  // above the floor, median over the frames
  // It drifts, and the first images see no floor: floor_m is off by what it drifted before one did.
  bool floor_is_late = false;
  double share_below = 0.0;  // of all surface seen, what lies clearly lower than the floor
};

// Whether the floor may be a table that fills the images: beside it they see what lies lower. Of a
// floor they see little, reflections or steps.
inline bool IsTable(const Gravity& gravity) { return gravity.share_below > 0.01; }

class GravityFinder {
 public:
  // An undistorted image of the recording; a dozen spread over it are enough.
  void Add(const DepthImage& image, const PinholeCamera& camera, const Pose3& world_from_camera);
  // One of the recording's first, in order of time: where SLAM's tilt drifts, its world is level as
  // these have it. Images given to Add() may be given too.
  void AddFirst(const DepthImage& image, const PinholeCamera& camera,
                const Pose3& world_from_camera);

  // Nothing when no plane below the cameras is large enough. Assumes that images are upright
  // within 50 degrees on average (not portrait).
  std::optional<Gravity> Find() const;

 private:
  std::vector<internal::SurfaceView> views_;
  std::vector<internal::SurfaceView> first_views_;
  Eigen::Vector3d image_up_ = Eigen::Vector3d::Zero();  // sum over the frames, in the world
};

}  // namespace depthgrid
