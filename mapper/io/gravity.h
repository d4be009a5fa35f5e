// Finds up in a recording whose world is not level, from the floor's plane in some of its depth
// images and their poses (docs/formats.md, "World conventions").
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/pose3.h"
#include "mapper/io/images_up.h"
#include "mapper/io/surface_view.h"

namespace depthgrid {

struct Gravity {
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();
  // 90 % quantile of the angle between up in single images and up_in_world: SLAM's tilt drifts and
  // normals have errors.
  double wander_rad = 0.0;
  // Of the images' mean: wander_rad over the root of their number.
  double error_rad = 0.0;
  // wander_rad is more than errors of normals explain: SLAM's tilt drifts, and up is from the first
  // images.
  bool drifts = false;
  // up . point for points of the floor. From the first images if SLAM's height drifts so much that
  // the images disagree.
  double floor_m = 0.0;
  double camera_height_m = 0.0;  // above the floor, median over the frames
  // It drifts, and the first images see no floor: floor_m includes the drift until one did.
  bool floor_is_late = false;
  double share_below = 0.0;  // share of all surface seen that is clearly below the floor
  // More stands on what is seen above, as if that were the floor and the images upside down.
  bool crowded_above = false;
};

// Whether the "floor" may be a table that fills the images, with lower surfaces beside it. Below a
// real floor there is little: reflections or steps.
inline bool IsTable(const Gravity& gravity) { return gravity.share_below > 0.01; }

class GravityFinder {
 public:
  // An undistorted image of the recording; a dozen spread over it are enough.
  void Add(const DepthImage& image, const PinholeCamera& camera, const Pose3& world_from_camera);
  // Adds one of the recording's first images, in order of time; they define up if SLAM's tilt
  // drifts. They may have been given to Add() too.
  void AddFirst(const DepthImage& image, const PinholeCamera& camera,
                const Pose3& world_from_camera);

  // Nothing when no plane below the cameras is large enough. Assumes that images are upright
  // within 50 degrees on average, or that the camera turns (ImagesUp). `upside_down`: images are
  // held the other way up.
  std::optional<Gravity> Find(bool upside_down = false) const;

 private:
  std::vector<internal::SurfaceView> views_;
  std::vector<internal::SurfaceView> first_views_;
  ImagesUp images_up_;
};

}  // namespace depthgrid
