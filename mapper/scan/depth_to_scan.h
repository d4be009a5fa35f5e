// A depth image becomes a level scan (Eq. 1-2, docs/math.md "Depth to scan"): levelled by roll and
// pitch only, the nearest surface of each bearing inside the obstacle band, and the stretch of each
// bearing that the image shows to be free.
#pragma once

#include <vector>

#include "mapper/core/camera.h"
#include "mapper/core/camera_stand.h"
#include "mapper/core/depth_image.h"
#include "mapper/core/scan.h"
#include "mapper/scan/bearing_returns.h"
#include "mapper/scan/scan_beams.h"
#include "mapper/scan/scan_options.h"

namespace depthgrid {

// Scans of one image: the obstacle band and the level slice around the camera, with the depth
// noise.
struct ScanPair {
  Scan obstacles;
  Scan slice;
  NoiseWindow noise = {};
};

// Memory for conversions, kept from frame to frame.
struct ScanMemory {
  DepthImage transposed;
  BearingFan fan;
  BearingLineTable lines;
  NoiseWindow::Memory noise;
  ReturnsMemory returns;
  BearingViews views;
  BeamNumbers beams;
};

// The heights of a level slice above the camera's centre; `low_m` may be positive, `high_m`
// negative.
struct SliceHeights {
  double low_m = 0.0, high_m = 0.0;
};

class DepthToScan {
 public:
  // Throws InputError for options that contradict each other and for a camera that has distortion
  // (frame sources undo it) or fewer than 2 x 2 pixels.
  DepthToScan(const PinholeCamera& camera, const ScanOptions& options);

  // The scan in base axes.
  Scan Convert(const DepthImage& depth, const CameraStand& stand) const;
  // With roll, pitch and height of the pose.
  Scan Convert(const DepthImage& depth, const Pose3& slam_from_camera) const {
    return Convert(depth, StandOf(slam_from_camera, options_.floor_z_m));
  }
  // Convert(), and the same for a slice, reading the image once. `scans`: an earlier result
  // whose memory is reused.
  ScanPair ConvertBoth(const DepthImage& depth, const CameraStand& stand, const SliceHeights& slice,
                       ScanMemory& memory, ScanPair scans = {}) const;

  // For drawing the scan over the image it came from: the pixel (u, v) of each beam's hit, (-1, -1)
  // for beams without.
  std::vector<Eigen::Vector2d> HitPixels(const DepthImage& depth, const CameraStand& stand,
                                         const Scan& scan) const;

 private:
  PinholeCamera camera_;
  ScanOptions options_;
};

}  // namespace depthgrid
